//! The path of a ship: solutions for every strength of the prior, judged on trials left out.

use std::collections::BTreeMap;

use super::chosen::strongest_within_one_error;
use super::group::{AxisGroup, groups};
use super::prior::Prior;
use super::settings::BulkSettings;
use crate::statistics::TrialStatistics;
use sistership_identification::refine::{Fitted, RefineError};

/// The whole path of a ship, and where on it each axis stands.
pub struct SolvedPath {
    pub(super) groups: Vec<AxisGroup>,
    settings: BulkSettings,
    /// Strengths by group and axis; lambda by group and axis and strength.
    lambdas: Vec<Vec<f64>>,
    /// Mean square errors on trials left out, by group, axis, strength.
    errors: Vec<Vec<Vec<f64>>>,
    chosen: Vec<Vec<usize>>,
}

/// Solves the full path and chooses a strength for each axis, by trials left out.
///
/// # Errors
/// The settings, or statistics that do not go together or have no sample.
pub fn solve(
    trials: &[TrialStatistics],
    prior: Prior<'_>,
    settings: &BulkSettings,
) -> Result<SolvedPath, RefineError> {
    settings.check()?;
    let groups = groups(trials, prior)?;
    let (mut lambdas, mut errors, mut chosen) = (Vec::new(), Vec::new(), Vec::new());
    let settings = &prior.allows(settings);
    let untold = (settings.decade() * (1.0 / settings.lambda_min).log10()).round() as usize;
    for group in &groups {
        let path: Vec<f64> =
            settings.strengths().iter().map(|strength| strength * group.unit(prior)).collect();
        let folds = group.errors(&path);
        let of_axis =
            |axis: usize| folds.iter().map(|fold| fold[axis].as_slice()).collect::<Vec<&[f64]>>();
        let choose = |axis| {
            strongest_within_one_error(&of_axis(axis), path.len(), untold.min(path.len() - 1))
        };
        chosen.push((0..group.axes.len()).map(choose).collect());
        errors.push((0..group.axes.len()).map(|axis| mean(&of_axis(axis))).collect());
        lambdas.push(path);
    }
    Ok(SolvedPath { groups, settings: *settings, lambdas, errors, chosen })
}

/// The mean over folds, by strength.
fn mean(folds: &[&[f64]]) -> Vec<f64> {
    let strengths = folds.first().map_or(0, |fold| fold.len());
    (0..strengths)
        .map(|k| folds.iter().map(|fold| fold[k]).sum::<f64>() / folds.len() as f64)
        .collect()
}

impl SolvedPath {
    /// Where an axis stands when the prior is so many decades stronger than chosen; none where
    /// nothing but the prior is left.
    fn at(&self, group: usize, axis: usize, pulled: usize) -> Option<usize> {
        let index =
            self.chosen[group][axis] + (pulled as f64 * self.settings.decade()).round() as usize;
        (pulled == 0 || index < self.settings.lambda_count).then_some(index)
    }

    /// The coefficients with a prior so many decades stronger than chosen, and whether anything but
    /// the prior is left.
    pub fn coefficients(&self, pulled: usize) -> (BTreeMap<String, Fitted>, bool) {
        let mut all = BTreeMap::new();
        let mut moved = false;
        for (index, group) in self.groups.iter().enumerate() {
            let directions = &group.root * group.whole.basis();
            for axis in 0..group.axes.len() {
                let at = self.at(index, axis, pulled);
                moved |= at.is_some();
                let lambda = at.map(|at| self.lambdas[index][at]);
                let fitted = group.fitted(
                    axis,
                    &directions,
                    lambda,
                    *self.lambdas[index].last().unwrap_or(&1.0),
                );
                all.extend(group.names[axis].iter().cloned().zip(fitted));
            }
        }
        (all, moved)
    }

    /// Lambda by which strengths of a group are measured, from the weakest.
    pub(super) fn strength(&self, group: usize, axis: usize, pulled: usize) -> f64 {
        let strengths = self.settings.strengths();
        self.at(group, axis, pulled)
            .and_then(|at| strengths.get(at).copied())
            .unwrap_or(self.settings.lambda_max)
    }

    /// Mean square errors of an axis on trials left out.
    pub(super) fn error(&self, group: usize, axis: usize, pulled: usize) -> f64 {
        let errors = &self.errors[group][axis];
        self.at(group, axis, pulled)
            .and_then(|at| errors.get(at))
            .or(errors.last())
            .copied()
            .unwrap_or(f64::NAN)
    }
}
