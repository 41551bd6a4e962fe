//! The statistics of a trial, and what coefficients leave of it.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;

use super::frame::{FORMAT, Frame};
use super::packed;
use sistership_identification::refine::{Block, RefineError, trial_moments, trial_tables};
use sistership_numerics::Moments;

/// The statistics of one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialStatistics {
    /// Always [`FORMAT`].
    pub format: String,
    /// Time from the first to the last sample, s.
    pub duration_s: f64,
    /// One set for each regression of the law.
    pub regressions: Vec<Regression>,
}

/// The statistics of one regression over a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Regression {
    /// The axes that share its regressors.
    pub axes: Vec<Axis>,
    /// Names of the coefficients by axis; the same place in each is the same regressor.
    pub names: Vec<Vec<String>>,
    /// How many times the precision of each one's prior is the common one.
    pub shrinkage: Vec<f64>,
    /// What the targets are of the coefficients, by target and axis.
    pub mixing: Vec<Vec<f64>>,
    /// Counts, means and products.
    #[serde(with = "packed")]
    pub moments: Moments,
}

/// What the coefficients of an axis leave of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisResidual {
    /// The axis.
    pub axis: Axis,
    /// Mean square of what they leave, in the units of the axis' targets.
    pub residual: f64,
    /// Mean square of the target itself.
    pub target: f64,
}

impl TrialStatistics {
    /// Of a trial, in a frame.
    ///
    /// # Errors
    /// Names the channel that the trial lacks.
    pub fn of(frame: &Frame, trial: &Trial) -> Result<Self, RefineError> {
        let (blocks, difference_s) = (&frame.blocks, Some(frame.difference_s));
        let moments = match &frame.beside {
            None => trial_moments(blocks, trial, difference_s)?,
            Some(beside) => {
                let added = beside.along(trial)?;
                let known = |axis: Axis, sample: usize| added.at(axis, sample);
                let tables = trial_tables(blocks, trial, difference_s, &known)?;
                let pairs = blocks.blocks.iter().zip(&tables);
                pairs.map(|(one, table)| Moments::of_columns(table, one.regressors())).collect()
            }
        };
        let regressions = frame
            .blocks
            .blocks
            .iter()
            .zip(moments)
            .map(|(block, moments)| Regression::of(block, moments));
        Ok(Self {
            format: FORMAT.to_owned(),
            duration_s: trial.duration_s(),
            regressions: regressions.collect(),
        })
    }

    /// Checks that lists and statistics go together.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn check(&self) -> Result<(), RefineError> {
        let refuse = |what: &str| Err(RefineError::Data(format!("statistics: {what}")));
        if self.format != FORMAT {
            return refuse(&format!("the format is `{}`, not `{FORMAT}`", self.format));
        }
        if self.regressions.iter().all(Regression::is_whole) {
            Ok(())
        } else {
            refuse("lists and numbers do not go together")
        }
    }

    /// Whether two trials were regressed in the same frame, so that their statistics may be added.
    pub fn goes_with(&self, other: &Self) -> bool {
        let same = |(a, b): (&Regression, &Regression)| {
            (&a.axes, &a.names, &a.mixing) == (&b.axes, &b.names, &b.mixing)
        };
        self.regressions.len() == other.regressions.len()
            && self.regressions.iter().zip(&other.regressions).all(same)
    }

    /// What coefficients leave of each axis; those that are not named count as zero.
    ///
    /// # Errors
    /// The statistics mix axes that cannot be told apart.
    pub fn left_by(
        &self,
        coefficients: &BTreeMap<String, f64>,
    ) -> Result<Vec<AxisResidual>, RefineError> {
        let mut all = Vec::new();
        for regression in &self.regressions {
            all.extend(regression.left_by(coefficients)?);
        }
        Ok(all)
    }
}

impl Regression {
    /// From targets to axes: the inverse of the mixing.
    ///
    /// # Errors
    /// It has none.
    pub fn unmixing(&self) -> Result<DMatrix<f64>, RefineError> {
        let q = self.axes.len();
        let mixing = DMatrix::from_fn(q, q, |target, axis| self.mixing[target][axis]);
        mixing.try_inverse().ok_or_else(|| {
            RefineError::Data("the statistics mix axes that cannot be told apart".into())
        })
    }

    /// Whether its lists are as long as its statistics need.
    fn is_whole(&self) -> bool {
        let (p, q) = (self.moments.regressors(), self.moments.targets());
        let rows = self.mixing.len() == q && self.mixing.iter().all(|row| row.len() == q);
        let names = self.names.len() == q && self.names.iter().all(|names| names.len() == p);
        rows && names && self.axes.len() == q && self.shrinkage.len() == p
    }

    fn of(block: &Block, moments: Moments) -> Self {
        let row = |target: usize| block.mixing.row(target).iter().copied().collect();
        Self {
            axes: block.axes.clone(),
            names: block.names.clone(),
            shrinkage: block.shrinkage.clone(),
            mixing: (0..block.axes.len()).map(row).collect(),
            moments: moments.symmetric(),
        }
    }

    fn left_by(
        &self,
        coefficients: &BTreeMap<String, f64>,
    ) -> Result<Vec<AxisResidual>, RefineError> {
        let (raw, unmixing) = (self.moments.raw_products(), self.unmixing()?);
        let p = self.moments.regressors();
        let mean_square = |weights: &DVector<f64>| weights.dot(&(&raw * weights)).max(0.0);
        let one = |(index, &axis): (usize, &Axis)| {
            let mut weights = DVector::zeros(raw.nrows());
            (0..self.axes.len()).for_each(|target| weights[p + target] = unmixing[(index, target)]);
            let target = mean_square(&weights);
            let values =
                self.names[index].iter().map(|name| coefficients.get(name).copied().unwrap_or(0.0));
            values.enumerate().for_each(|(j, value)| weights[j] = -value);
            AxisResidual { axis, residual: mean_square(&weights), target }
        };
        Ok(self.axes.iter().enumerate().map(one).collect())
    }
}
