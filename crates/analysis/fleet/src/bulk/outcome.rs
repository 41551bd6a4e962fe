//! What a refinement from statistics gives.

use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;

use super::sails::SailedFigures;

/// A refinement from statistics, with what speaks for and against it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BulkRefinement {
    /// Every coefficient.
    pub coefficients: Vec<Coefficient>,
    /// Every axis.
    pub axes: Vec<AxisOutcome>,
    /// How many decades stronger than chosen the prior had to be for the model to sail what the one
    /// before sails.
    pub pulled: usize,
    /// Manoeuvres of the model before.
    pub before: SailedFigures,
    /// Manoeuvres of the refined model.
    pub after: SailedFigures,
    /// How many trials it is made of.
    pub trials: usize,
}

/// A coefficient before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    /// Its name.
    pub name: String,
    /// Of the model before.
    pub before: f64,
    /// The prior's mean.
    pub prior: f64,
    /// The prior's standard deviation, at the strength that was taken.
    pub prior_deviation: f64,
    /// Refined.
    pub refined: f64,
    /// Posterior standard error.
    pub standard_error: f64,
}

/// The errors of an axis: root mean squares of what is left of its target, by that of the target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisOutcome {
    /// The axis.
    pub axis: Axis,
    /// Strength of the prior: lambda for a source; for a family's prior how many times tighter than
    /// learned.
    pub strength: f64,
    /// Of the model before, on all trials.
    pub before: f64,
    /// Of the prior's mean, on all trials.
    pub prior: f64,
    /// Of the refined coefficients, each trial left out in turn; of a single trial, on itself.
    pub after: f64,
}

impl BulkRefinement {
    /// By how much the worst axis is worse than before, by its error before; below zero where every
    /// axis is better.
    pub fn worst_change(&self) -> f64 {
        let change = |axis: &AxisOutcome| axis.after / axis.before.max(f64::MIN_POSITIVE) - 1.0;
        self.axes.iter().map(change).fold(f64::NEG_INFINITY, f64::max)
    }
}
