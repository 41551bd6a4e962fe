//! Result of a refinement from statistics.

use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;

use super::manoeuvre_check::ManoeuvreFigures;

/// Result of a refinement from statistics, with the errors before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BulkRefinement {
    /// All coefficients.
    pub coefficients: Vec<CoefficientOutcome>,
    /// All axes.
    pub axes: Vec<AxisOutcome>,
    /// Number of decades by which the prior had to be stronger than selected until the model
    /// simulated every manoeuvre that the model before does.
    pub pulled: usize,
    /// Manoeuvres of the model before.
    pub before: ManoeuvreFigures,
    /// Manoeuvres of the refined model.
    pub after: ManoeuvreFigures,
    /// Number of trials.
    pub trials: usize,
}

/// Coefficient before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoefficientOutcome {
    /// Name of the coefficient.
    pub name: String,
    /// Value of the model before.
    pub before: f64,
    /// Mean of the prior.
    pub prior: f64,
    /// Standard deviation of the prior, at the selected strength.
    pub prior_deviation: f64,
    /// Refined value.
    pub refined: f64,
    /// Posterior standard error.
    pub standard_error: f64,
}

/// Errors of an axis: root mean squared residual of its target, relative to that of the target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisOutcome {
    /// Axis of the errors.
    pub axis: Axis,
    /// Strength of the prior: lambda for a source; for a family's prior, the factor by which it is
    /// tighter than learned.
    pub strength: f64,
    /// Error of the model before, on all trials.
    pub before: f64,
    /// Error of the prior's mean, on all trials.
    pub prior: f64,
    /// Error of the refined coefficients, each trial held out in turn; a single trial is evaluated
    /// on itself.
    pub after: f64,
}

impl BulkRefinement {
    /// Relative change of the error of the worst axis; negative if every axis is better.
    pub fn worst_change(&self) -> f64 {
        let change = |axis: &AxisOutcome| axis.after / axis.before.max(f64::MIN_POSITIVE) - 1.0;
        self.axes.iter().map(change).fold(f64::NEG_INFINITY, f64::max)
    }
}
