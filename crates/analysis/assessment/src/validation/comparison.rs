//! Comparison of a model's manoeuvres with published ones.

use serde::Serialize;
use sistership_model::free_running::{FreeRunning, PublishedTurn, PublishedZigzag};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};

use crate::validation::limits::{OVERSHOOT_DEG, OVERSHOOT_SHARE, TURN_SHARE};

/// One published figure, compared with the model's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureComparison {
    /// The figure: `turn 35 deg: advance`.
    pub figure: String,
    /// `L` for ship lengths, or `deg`.
    pub unit: &'static str,
    /// Key of the source.
    pub source: String,
    /// As published.
    pub published: f64,
    /// Half the width of its 95 % interval.
    pub uncertainty: f64,
    /// As simulated by the model; none if the simulation does not reach it.
    pub sailed: Option<f64>,
    /// Largest difference that is allowed.
    pub limit: f64,
}

impl FigureComparison {
    /// Returns the model's figure less the published one.
    pub fn error(&self) -> Option<f64> {
        self.sailed.map(|sailed| sailed - self.published)
    }

    /// Returns true if the model is within the limit; false if it does not reach the figure.
    pub fn is_within(&self) -> bool {
        self.error().is_some_and(|error| error.abs() <= self.limit)
    }
}

/// Simulates published manoeuvres at the published speed, and compares the figures.
pub fn compare_published(ship: &Ship, trials: &[FreeRunning]) -> Vec<FigureComparison> {
    compare_with_steps(ship, trials, 1.0)
}

/// Simulates published manoeuvres with steps of `steps` times the usual ones, and compares the
/// figures.
pub(crate) fn compare_with_steps(
    ship: &Ship,
    trials: &[FreeRunning],
    steps: f64,
) -> Vec<FigureComparison> {
    trials.iter().flat_map(|trial| trial_comparisons(ship, trial, steps)).collect()
}

fn trial_comparisons(ship: &Ship, trial: &FreeRunning, steps: f64) -> Vec<FigureComparison> {
    let usual = ManoeuvreSettings {
        speed_m_s: trial.speed_m_s,
        reversals_within_steps: true,
        ..ManoeuvreSettings::default()
    };
    // A ratio of 1 leaves the step to the settings.
    let step_s = (steps != 1.0).then(|| steps * usual.step_length_s(ship));
    let settings = ManoeuvreSettings { step_s, ..usual };
    let turns = trial.turns.iter().flat_map(|published| {
        let sailed = side_means(published.rudder_deg, published.both_sides, |rudder| {
            turn_figures(ship, rudder, &settings)
        });
        turn_comparisons(&trial.source, published, sailed)
    });
    let zigzags = trial.zigzags.iter().flat_map(|published| {
        let sailed = side_means(published.rudder_deg, published.both_sides, |rudder| {
            zigzag_figures(ship, rudder, published.switch_deg, &settings)
        });
        zigzag_comparisons(&trial.source, published, sailed)
    });
    turns.chain(zigzags).collect()
}

/// Figures of a manoeuvre, or their means over both sides.
fn side_means<const N: usize>(
    rudder_deg: f64,
    both: bool,
    sail: impl Fn(f64) -> [Option<f64>; N],
) -> [Option<f64>; N] {
    let one = sail(rudder_deg);
    if !both {
        return one;
    }
    let other = sail(-rudder_deg);
    std::array::from_fn(|k| Some(0.5 * (one[k]? + other[k]?)))
}

fn turn_figures(ship: &Ship, rudder_deg: f64, settings: &ManoeuvreSettings) -> [Option<f64>; 4] {
    // A manoeuvre that stops early has no figures; this is reported, not an error.
    let Ok(sailed) = simulate_turn(ship, rudder_deg, settings) else { return [None; 4] };
    let of = sailed.metrics;
    [of.advance_m, of.transfer_m, of.tactical_diameter_m, of.steady_radius_m]
        .map(|figure| figure.map(|metres| metres / ship.lpp_m()))
}

fn zigzag_figures(
    ship: &Ship,
    rudder_deg: f64,
    switch_deg: f64,
    settings: &ManoeuvreSettings,
) -> [Option<f64>; 2] {
    match simulate_zigzag(ship, rudder_deg, switch_deg, settings) {
        Ok(sailed) => [sailed.metrics.first_overshoot_deg, sailed.metrics.second_overshoot_deg],
        Err(_) => [None; 2],
    }
}

fn turn_comparisons(
    source: &str,
    turn: &PublishedTurn,
    sailed: [Option<f64>; 4],
) -> Vec<FigureComparison> {
    let one = |((name, published), sailed): ((&str, Option<f64>), Option<f64>)| {
        let published = published?;
        Some(FigureComparison {
            figure: format!("turn {} deg: {name}", turn.rudder_deg),
            unit: "L",
            source: source.to_owned(),
            published,
            uncertainty: turn.uncertainty,
            sailed,
            limit: TURN_SHARE * published.abs() + turn.uncertainty,
        })
    };
    turn.named_figures().into_iter().zip(sailed).filter_map(one).collect()
}

fn zigzag_comparisons(
    source: &str,
    zigzag: &PublishedZigzag,
    sailed: [Option<f64>; 2],
) -> Vec<FigureComparison> {
    let one = |((name, published), sailed): ((&str, Option<f64>), Option<f64>)| {
        let published = published?;
        let allowed = OVERSHOOT_DEG.max(OVERSHOOT_SHARE * published.abs());
        Some(FigureComparison {
            figure: format!("zigzag {}/{}: {name}", zigzag.rudder_deg, zigzag.switch_deg),
            unit: "deg",
            source: source.to_owned(),
            published,
            uncertainty: zigzag.uncertainty_deg,
            sailed,
            limit: allowed + zigzag.uncertainty_deg,
        })
    };
    zigzag.named_figures().into_iter().zip(sailed).filter_map(one).collect()
}
