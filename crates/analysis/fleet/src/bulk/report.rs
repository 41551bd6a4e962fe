//! Errors and coefficients of a refinement from statistics.

use std::collections::BTreeMap;

use super::manoeuvre_check::ManoeuvreFigures;
use super::outcome::{AxisOutcome, BulkRefinement, CoefficientOutcome};
use super::request::BulkRequest;
use super::ridge_path::ShipRidgePath;
use crate::statistics::TrialStatistics;
use sistership_identification::refine::{FittedCoefficient, RefineError};

/// Result of a ship from its path, with the prior `pulled` decades stronger than selected.
///
/// # Errors
/// Returns an error if the statistics mix axes that cannot be distinguished.
pub(super) fn refinement_outcome(
    solved: &ShipRidgePath,
    request: &BulkRequest<'_>,
    pulled: usize,
    fitted: &BTreeMap<String, FittedCoefficient>,
    (before, after): (ManoeuvreFigures, ManoeuvreFigures),
) -> Result<BulkRefinement, RefineError> {
    let mut priors = BTreeMap::new();
    for group in &solved.groups {
        let pairs = group
            .names
            .iter()
            .zip(&group.means)
            .flat_map(|(names, means)| names.iter().cloned().zip(means.iter().copied()));
        priors.extend(pairs);
    }
    let values = request
        .model
        .coefficients
        .iter()
        .map(|(name, quantity)| (name.clone(), quantity.value))
        .collect();
    let axes = axis_outcomes(solved, request.trials, pulled, &values, &priors)?;
    let coefficient = |(name, fitted): (&String, &FittedCoefficient)| CoefficientOutcome {
        name: name.clone(),
        before: request.model.coefficient(name),
        prior: priors.get(name).copied().unwrap_or(0.0),
        prior_deviation: fitted.prior_deviation,
        refined: fitted.value,
        standard_error: fitted.standard_error,
    };
    let coefficients = fitted.iter().map(coefficient).collect();
    Ok(BulkRefinement { coefficients, axes, pulled, before, after, trials: request.trials.len() })
}

/// Errors of all axes, before, of the prior and after.
fn axis_outcomes(
    solved: &ShipRidgePath,
    trials: &[TrialStatistics],
    pulled: usize,
    before: &BTreeMap<String, f64>,
    priors: &BTreeMap<String, f64>,
) -> Result<Vec<AxisOutcome>, RefineError> {
    let (before, prior) = (mean_residuals(trials, before)?, mean_residuals(trials, priors)?);
    // Order of the axes in the residuals: group by group.
    let places = solved
        .groups
        .iter()
        .enumerate()
        .flat_map(|(g, group)| (0..group.axes.len()).map(move |axis| (g, axis)));
    let one = |(place, (group, axis)): (usize, (usize, usize))| {
        let (left, target) = before[place];
        AxisOutcome {
            axis: solved.groups[group].axes[axis],
            strength: solved.strength_at(group, axis, pulled),
            before: (left / target).sqrt(),
            prior: (prior[place].0 / target).sqrt(),
            after: (solved.error_at(group, axis, pulled) / target).sqrt(),
        }
    };
    Ok(places.enumerate().map(one).collect())
}

/// Mean squared residuals and targets by axis, averaged over the trials.
fn mean_residuals(
    trials: &[TrialStatistics],
    coefficients: &BTreeMap<String, f64>,
) -> Result<Vec<(f64, f64)>, RefineError> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for trial in trials {
        let left = trial.axis_residuals(coefficients)?;
        // The number of axes is known from the first trial only.
        all.resize(left.len(), (0.0, 0.0));
        let share = 1.0 / trials.len() as f64;
        all.iter_mut().zip(left).for_each(|(sum, left)| {
            *sum = (sum.0 + share * left.residual, sum.1 + share * left.target)
        });
    }
    Ok(all
        .into_iter()
        // The target is a divisor.
        .map(|(residual, target)| (residual, target.max(f64::MIN_POSITIVE)))
        .collect())
}
