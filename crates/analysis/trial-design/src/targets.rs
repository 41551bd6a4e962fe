//! Targets of a design: figures of the IMO criteria, and parameters of effects, with their changes
//! by the deviations of the unknowns.

use nalgebra::{DMatrix, DVector};
use sistership_assessment::uncertainty::{DrawFigures, figures_by_name};
use sistership_model::Model;
use sistership_model::law::Law;

use crate::thresholds::THRESHOLDS;
use crate::unknowns::UnknownDeviations;

/// Figures that IMO MSC.137(76) judges, each to either side, and their units.
const FIGURES: [(&str, &str); 11] = [
    ("turn 35 deg: advance", "m"),
    ("turn -35 deg: advance", "m"),
    ("turn 35 deg: tactical diameter", "m"),
    ("turn -35 deg: tactical diameter", "m"),
    ("initial turning", "m"),
    ("zigzag 10/10: first overshoot", "deg"),
    ("zigzag -10/10: first overshoot", "deg"),
    ("zigzag 10/10: second overshoot", "deg"),
    ("zigzag -10/10: second overshoot", "deg"),
    ("zigzag 20/20: first overshoot", "deg"),
    ("zigzag -20/20: first overshoot", "deg"),
];

/// A target of a design.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DesignTarget {
    /// Figure, or `effect: parameter`.
    pub name: String,
    /// Unit; empty where the name contains it.
    pub unit: &'static str,
    /// Value by the model.
    pub value: f64,
    /// Change with each deviation.
    pub gradient: DVector<f64>,
}

/// Targets of a design, and the figures that the model does not reach.
pub(crate) fn design_targets(
    model: &Model,
    law: &Law,
    unknowns: &UnknownDeviations,
) -> Option<(Vec<DesignTarget>, Vec<String>)> {
    let count = unknowns.coefficients.len();
    // The estimate first, then one deviation to either side of each coefficient.
    let models: Vec<Model> = std::iter::once(unknowns.move_coefficients(model, 0, 0.0))
        .chain(
            (0..count)
                .flat_map(|j| [1.0, -1.0].map(|side| unknowns.move_coefficients(model, j, side))),
        )
        .collect();
    let sailed = figures_by_name(&models[0], law, &models)?;
    let (estimate, moved) = sailed.split_first()?;
    let of = |(name, unit): &(&'static str, &'static str)| {
        let value = *estimate.get(*name)?;
        let mut gradient = DVector::zeros(unknowns.root.nrows());
        for (j, pair) in moved.chunks_exact(2).enumerate() {
            gradient[j] = secant_slope(name, value, &pair[0], &pair[1]);
        }
        Some(DesignTarget { name: (*name).to_owned(), unit, value, gradient })
    };
    let mut all: Vec<DesignTarget> = FIGURES.iter().filter_map(of).collect();
    let unreached =
        FIGURES.iter().map(|(name, _)| *name).filter(|name| !estimate.contains_key(*name));
    let unreached = unreached.map(str::to_owned).collect();
    all.extend(effect_targets(unknowns));
    // A figure that does not depend on the unknowns cannot be improved.
    all.retain(|target| target.gradient.norm() > THRESHOLDS.least_scatter * target.value.abs());
    Some((all, unreached))
}

/// Change of a figure by a deviation: the secant over one to either side, so that a posterior as
/// wide as a figure is curved is judged over its own width (as the sigma points of Julier and
/// Uhlmann 2004, Proceedings of the IEEE 92, 401-422); over one side where the other does not reach
/// it.
fn secant_slope(name: &str, value: f64, above: &DrawFigures, below: &DrawFigures) -> f64 {
    match (above.get(name), below.get(name)) {
        (Some(above), Some(below)) => 0.5 * (above - below),
        (Some(above), None) => above - value,
        (None, Some(below)) => value - below,
        (None, None) => 0.0,
    }
}

fn effect_targets(unknowns: &UnknownDeviations) -> Vec<DesignTarget> {
    let first = unknowns.coefficients.len();
    let size = unknowns.root.nrows();
    let parameters = unknowns.effects.iter().flat_map(|effect| {
        effect.form.parameters.keys().zip(&effect.at).map(move |(name, at)| (effect, name, *at))
    });
    let one = |(k, (effect, name, value)): (usize, (&_, &String, f64))| {
        let effect: &sistership_filtering::EffectCandidate = effect;
        // A parameter of an effect is an unknown itself: its gradient is its own deviation.
        let mut gradient = DVector::zeros(size);
        gradient[first + k] = unknowns.root[(first + k, first + k)];
        DesignTarget {
            name: format!("{}: {name}", effect.candidate_key()),
            unit: "",
            value,
            gradient,
        }
    };
    parameters.enumerate().map(one).collect()
}

/// Gradients of targets as one matrix, targets by deviations.
pub(crate) fn gradient_matrix(targets: &[DesignTarget]) -> DMatrix<f64> {
    let rows: Vec<_> = targets.iter().map(|target| target.gradient.transpose()).collect();
    DMatrix::from_rows(&rows)
}
