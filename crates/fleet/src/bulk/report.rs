//! What a refinement from statistics says for itself.

use std::collections::BTreeMap;

use super::outcome::{AxisOutcome, BulkRefinement, Coefficient};
use super::refine::BulkRequest;
use super::sails::Sailed;
use super::solved::Solved;
use crate::statistics::TrialStatistics;
use sistership_estimate::refine::{Fitted, RefineError};

impl Solved {
    pub(super) fn outcome(
        &self,
        request: &BulkRequest<'_>,
        pulled: usize,
        fitted: &BTreeMap<String, Fitted>,
        (before, after): (Sailed, Sailed),
    ) -> Result<BulkRefinement, RefineError> {
        let mut priors = BTreeMap::new();
        for group in &self.groups {
            let pairs =
                group.names.iter().zip(&group.means).flat_map(|(names, means)| names.iter().cloned().zip(means.iter().copied()));
            priors.extend(pairs);
        }
        let values = request.model.coefficients.iter().map(|(name, quantity)| (name.clone(), quantity.value)).collect();
        let axes = self.axes(request.trials, pulled, &values, &priors)?;
        let coefficient = |(name, fitted): (&String, &Fitted)| Coefficient {
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

    fn axes(
        &self,
        trials: &[TrialStatistics],
        pulled: usize,
        before: &BTreeMap<String, f64>,
        priors: &BTreeMap<String, f64>,
    ) -> Result<Vec<AxisOutcome>, RefineError> {
        let (before, prior) = (left(trials, before)?, left(trials, priors)?);
        let places = self.groups.iter().enumerate().flat_map(|(g, group)| (0..group.axes.len()).map(move |axis| (g, axis)));
        let one = |(place, (group, axis)): (usize, (usize, usize))| {
            let (left, target) = before[place];
            AxisOutcome {
                axis: self.groups[group].axes[axis],
                strength: self.strength(group, axis, pulled),
                before: (left / target).sqrt(),
                prior: (prior[place].0 / target).sqrt(),
                after: (self.error(group, axis, pulled) / target).sqrt(),
            }
        };
        Ok(places.enumerate().map(one).collect())
    }
}

/// Mean squares of what coefficients leave and of the targets, by axis, in the mean over the trials.
fn left(trials: &[TrialStatistics], coefficients: &BTreeMap<String, f64>) -> Result<Vec<(f64, f64)>, RefineError> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for trial in trials {
        let left = trial.left_by(coefficients)?;
        all.resize(left.len(), (0.0, 0.0));
        let share = 1.0 / trials.len() as f64;
        all.iter_mut().zip(left).for_each(|(sum, left)| *sum = (sum.0 + share * left.residual, sum.1 + share * left.target));
    }
    Ok(all.into_iter().map(|(residual, target)| (residual, target.max(f64::MIN_POSITIVE))).collect())
}
