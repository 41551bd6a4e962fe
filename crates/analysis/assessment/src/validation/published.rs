//! Quantities of published free-running trials.

use sistership_model::free_running::FreeRunning;
use sistership_simulation::Ship;

use crate::validation::comparison::{FigureComparison, compare_with_steps};
use crate::validation::convergence::step_uncertainty;
use crate::validation::quantity::{NORMAL_95, QuantityEvidence, mean_and_spread};

/// Steps of draws relative to the usual ones: their scatter needs no finer ones.
const STEPS_OF_DRAWS: f64 = 2.5;

/// Returns the evidence on every published figure; `draws` are ships with coefficients from the
/// model's posterior.
pub fn published_evidence(
    ship: &Ship,
    draws: &[Ship],
    trials: &[FreeRunning],
) -> Vec<QuantityEvidence> {
    // Three steps for the study of convergence; figures are in the same order for all of them.
    let by_step = [1.0, 2.0, 4.0].map(|steps| compare_with_steps(ship, trials, steps));
    let by_draw: Vec<Vec<FigureComparison>> =
        draws.iter().map(|draw| compare_with_steps(draw, trials, STEPS_OF_DRAWS)).collect();
    let one = |(k, figure): (usize, &FigureComparison)| {
        let steps = by_step.each_ref().map(|all| all[k].sailed);
        let step_uncertainty = match steps {
            [Some(fine), Some(medium), Some(coarse)] => step_uncertainty([fine, medium, coarse]),
            _ => None,
        };
        // The same figure of every draw.
        let drawn: Vec<Option<f64>> = by_draw.iter().map(|all| all[k].sailed).collect();
        QuantityEvidence {
            quantity: figure.figure.clone(),
            unit: figure.unit,
            data_from: figure.source.clone(),
            records: None,
            data: figure.published,
            simulated: figure.sailed,
            data_uncertainty: Some(figure.uncertainty),
            step_uncertainty,
            input_uncertainty: draw_uncertainty(&drawn),
        }
    };
    by_step[0].iter().enumerate().map(one).collect()
}

/// Returns half the width of the 95 % interval of draws; `None` without draws, or if one does not
/// reach the figure.
pub fn draw_uncertainty(drawn: &[Option<f64>]) -> Option<f64> {
    let all: Option<Vec<f64>> = drawn.iter().copied().collect();
    mean_and_spread(&all?).map(|(_, spread)| NORMAL_95 * spread)
}
