//! Statistics of a trial, and residuals of coefficients on it.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;

use super::frame::{FORMAT, RegressionFrame};
use super::packed;
use sistership_identification::refine::{
    RefineError, RegressionBlock, trial_moments, trial_tables,
};
use sistership_numerics::RegressionMoments;

/// Statistics of one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialStatistics {
    /// Always [`FORMAT`].
    pub format: String,
    /// Time from the first to the last sample, s.
    pub duration_s: f64,
    /// Statistics of each regression of the law.
    pub regressions: Vec<RegressionStatistics>,
}

/// Statistics of one regression over a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegressionStatistics {
    /// Axes that have these regressors in common.
    pub axes: Vec<Axis>,
    /// Names of the coefficients by axis; the same index in each is the same regressor.
    pub names: Vec<Vec<String>>,
    /// Precision of each coefficient's prior, relative to the common one.
    pub shrinkage: Vec<f64>,
    /// Mixing matrix from the coefficients' axes to the targets, by target and axis.
    pub mixing: Vec<Vec<f64>>,
    /// Counts, means and products.
    #[serde(with = "packed")]
    pub moments: RegressionMoments,
}

/// Residual of an axis on a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisResidual {
    /// Axis of the residual.
    pub axis: Axis,
    /// Mean squared residual, in the units of the axis' targets.
    pub residual: f64,
    /// Mean square of the target itself.
    pub target: f64,
}

impl TrialStatistics {
    /// Computes the statistics of a trial in a frame.
    ///
    /// # Errors
    /// Returns an error that names the missing channel.
    pub fn from_trial(frame: &RegressionFrame, trial: &Trial) -> Result<Self, RefineError> {
        let (blocks, difference_s) = (&frame.blocks, Some(frame.difference_s));
        let moments = match &frame.beside {
            None => trial_moments(blocks, trial, difference_s)?,
            // The law's regressions are for the acceleration that the correction does not add.
            Some(beside) => {
                let added = beside.additions_along(trial)?;
                let known = |axis: Axis, sample: usize| added.value_at(axis, sample);
                let tables = trial_tables(blocks, trial, difference_s, &known)?;
                let pairs = blocks.blocks.iter().zip(&tables);
                pairs
                    .map(|(one, table)| {
                        RegressionMoments::from_columns(table, one.regressor_count())
                    })
                    .collect()
            }
        };
        let regressions = frame
            .blocks
            .blocks
            .iter()
            .zip(moments)
            .map(|(block, moments)| RegressionStatistics::from_block(block, moments));
        Ok(Self {
            format: FORMAT.to_owned(),
            duration_s: trial.duration_s(),
            regressions: regressions.collect(),
        })
    }

    /// Checks that the lists match the statistics.
    ///
    /// # Errors
    /// Returns an error with the fault.
    pub fn check_consistency(&self) -> Result<(), RefineError> {
        let refuse = |what: &str| Err(RefineError::Data(format!("statistics: {what}")));
        if self.format != FORMAT {
            return refuse(&format!("the format is `{}`, not `{FORMAT}`", self.format));
        }
        if self.regressions.iter().all(RegressionStatistics::is_consistent) {
            Ok(())
        } else {
            refuse("the lengths of its lists do not match")
        }
    }

    /// True if two trials were regressed in the same frame, so that their statistics may be added.
    pub fn has_same_frame(&self, other: &Self) -> bool {
        let same = |(a, b): (&RegressionStatistics, &RegressionStatistics)| {
            (&a.axes, &a.names, &a.mixing) == (&b.axes, &b.names, &b.mixing)
        };
        self.regressions.len() == other.regressions.len()
            && self.regressions.iter().zip(&other.regressions).all(same)
    }

    /// Residuals of given coefficients for each axis; coefficients that are not named count as
    /// zero.
    ///
    /// # Errors
    /// Returns an error if the statistics mix axes that cannot be distinguished.
    pub fn axis_residuals(
        &self,
        coefficients: &BTreeMap<String, f64>,
    ) -> Result<Vec<AxisResidual>, RefineError> {
        let mut all = Vec::new();
        for regression in &self.regressions {
            all.extend(regression.axis_residuals(coefficients)?);
        }
        Ok(all)
    }
}

impl RegressionStatistics {
    /// Matrix from targets to axes: the inverse of the mixing matrix.
    ///
    /// # Errors
    /// Returns an error if the mixing matrix is singular.
    pub fn unmixing_matrix(&self) -> Result<DMatrix<f64>, RefineError> {
        let q = self.axes.len();
        let mixing = DMatrix::from_fn(q, q, |target, axis| self.mixing[target][axis]);
        mixing.try_inverse().ok_or_else(|| {
            RefineError::Data("the statistics combine axes that cannot be separated".into())
        })
    }

    /// True if the lists have the lengths that the statistics need.
    fn is_consistent(&self) -> bool {
        let (p, q) = (self.moments.regressors(), self.moments.targets());
        // The mixing matrix is square, with one row for each target.
        let rows = self.mixing.len() == q && self.mixing.iter().all(|row| row.len() == q);
        let names = self.names.len() == q && self.names.iter().all(|names| names.len() == p);
        rows && names && self.axes.len() == q && self.shrinkage.len() == p
    }

    /// Statistics of a block of the regression.
    fn from_block(block: &RegressionBlock, moments: RegressionMoments) -> Self {
        let row = |target: usize| block.mixing.row(target).iter().copied().collect();
        Self {
            axes: block.axes.clone(),
            names: block.names.clone(),
            shrinkage: block.shrinkage.clone(),
            mixing: (0..block.axes.len()).map(row).collect(),
            // Exactly symmetric, so that the document gives the same numbers when it is read back.
            moments: moments.symmetrize_products(),
        }
    }

    fn axis_residuals(
        &self,
        coefficients: &BTreeMap<String, f64>,
    ) -> Result<Vec<AxisResidual>, RefineError> {
        // With weights (-b, unmixing row) over regressors and targets, the mean squared residual is
        // w' E[z z'] w.
        let (raw, unmixing) = (self.moments.raw_products(), self.unmixing_matrix()?);
        let p = self.moments.regressors();
        let mean_square = |weights: &DVector<f64>| weights.dot(&(&raw * weights)).max(0.0);
        let one = |(index, &axis): (usize, &Axis)| {
            let mut weights = DVector::zeros(raw.nrows());
            (0..self.axes.len()).for_each(|target| weights[p + target] = unmixing[(index, target)]);
            // First with the target alone, then with the regressors.
            let target = mean_square(&weights);
            let values =
                self.names[index].iter().map(|name| coefficients.get(name).copied().unwrap_or(0.0));
            values.enumerate().for_each(|(j, value)| weights[j] = -value);
            AxisResidual { axis, residual: mean_square(&weights), target }
        };
        Ok(self.axes.iter().enumerate().map(one).collect())
    }
}
