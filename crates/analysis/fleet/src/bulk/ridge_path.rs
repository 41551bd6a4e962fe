//! Ridge path of a ship: solutions for every strength of the prior, evaluated on held-out trials.

use std::collections::BTreeMap;

use super::group::{AxisGroup, axis_groups};
use super::prior::BulkPrior;
use super::settings::BulkSettings;
use super::strength_selection::strongest_within_one_error;
use crate::statistics::TrialStatistics;
use sistership_identification::refine::{FittedCoefficient, RefineError};

/// Full path of a ship, with the selected strength of each axis.
pub struct ShipRidgePath {
    pub(super) groups: Vec<AxisGroup>,
    settings: BulkSettings,
    /// Lambda by group and strength.
    lambdas: Vec<Vec<f64>>,
    /// Mean squared errors on held-out trials, by group, axis, strength.
    errors: Vec<Vec<Vec<f64>>>,
    chosen: Vec<Vec<usize>>,
}

/// Solves the full path, and selects a strength for each axis by held-out trials.
///
/// # Errors
/// Returns an error for invalid settings, and for statistics that do not match or have no sample.
pub fn solve_path(
    trials: &[TrialStatistics],
    prior: BulkPrior<'_>,
    settings: &BulkSettings,
) -> Result<ShipRidgePath, RefineError> {
    settings.check()?;
    let groups = axis_groups(trials, prior)?;
    let (mut lambdas, mut errors, mut chosen) = (Vec::new(), Vec::new(), Vec::new());
    // Limited by the prior first: all strengths below refer to these settings.
    let settings = &prior.limit_settings(settings);
    // Index of strength 1, used if no trial can be held out.
    let untold =
        (settings.strengths_per_decade() * (1.0 / settings.lambda_min).log10()).round() as usize;
    for group in &groups {
        let path: Vec<f64> = settings
            .strength_path()
            .iter()
            .map(|strength| strength * group.unit_lambda(prior))
            .collect();
        let folds = group.held_out_errors(&path);
        let of_axis =
            |axis: usize| folds.iter().map(|fold| fold[axis].as_slice()).collect::<Vec<&[f64]>>();
        let choose = |axis| {
            // Each axis selects its own strength.
            strongest_within_one_error(&of_axis(axis), path.len(), untold.min(path.len() - 1))
        };
        chosen.push((0..group.axes.len()).map(choose).collect());
        errors.push((0..group.axes.len()).map(|axis| mean_errors(&of_axis(axis))).collect());
        lambdas.push(path);
    }
    Ok(ShipRidgePath { groups, settings: *settings, lambdas, errors, chosen })
}

/// Mean over the folds, by strength.
fn mean_errors(folds: &[&[f64]]) -> Vec<f64> {
    let strengths = folds.first().map_or(0, |fold| fold.len());
    (0..strengths)
        .map(|k| folds.iter().map(|fold| fold[k]).sum::<f64>() / folds.len() as f64)
        .collect()
}

impl ShipRidgePath {
    /// Index of an axis on the path with the prior `pulled` decades stronger than selected; `None`
    /// beyond the strongest, where the prior alone remains.
    fn path_index(&self, group: usize, axis: usize, pulled: usize) -> Option<usize> {
        let index = self.chosen[group][axis]
            + (pulled as f64 * self.settings.strengths_per_decade()).round() as usize;
        // The selected strength itself is always on the path.
        (pulled == 0 || index < self.settings.lambda_count).then_some(index)
    }

    /// Coefficients with the prior `pulled` decades stronger than selected, and true if any axis
    /// still uses its trials.
    pub fn coefficients_at(&self, pulled: usize) -> (BTreeMap<String, FittedCoefficient>, bool) {
        let mut all = BTreeMap::new();
        let mut moved = false;
        for (index, group) in self.groups.iter().enumerate() {
            // From the eigenbasis to the values of the coefficients.
            let directions = &group.root * group.whole.eigenvector_basis();
            for axis in 0..group.axes.len() {
                let at = self.path_index(index, axis, pulled);
                moved |= at.is_some();
                let lambda = at.map(|at| self.lambdas[index][at]);
                let fitted = group.fit_axis(
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

    /// Strength of the prior of an axis with the prior `pulled` decades stronger than selected.
    pub(super) fn strength_at(&self, group: usize, axis: usize, pulled: usize) -> f64 {
        let strengths = self.settings.strength_path();
        self.path_index(group, axis, pulled)
            .and_then(|at| strengths.get(at).copied())
            .unwrap_or(self.settings.lambda_max)
    }

    /// Mean squared error of an axis on held-out trials, likewise.
    pub(super) fn error_at(&self, group: usize, axis: usize, pulled: usize) -> f64 {
        let errors = &self.errors[group][axis];
        self.path_index(group, axis, pulled)
            .and_then(|at| errors.get(at))
            // Beyond the path, the error of the strongest prior.
            .or(errors.last())
            .copied()
            .unwrap_or(f64::NAN)
    }
}
