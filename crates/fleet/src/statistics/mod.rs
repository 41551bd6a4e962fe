//! Sufficient statistics of a trial as a document: what a regression needs of its samples, so that a ship is refined again, with
//! another prior or another trial, without reading samples.
//!
//! They depend on the trial and on everything that shapes the rows: law, particulars, parameters, names of the coefficients and
//! the time over which accelerations are differenced. [`Frame::key`] is a hash over all of it.

mod frame;
mod packed;
mod residual;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;

pub use frame::{FORMAT, Frame};
pub use residual::Left;

use sistership_estimate::refine::{Block, RefineError, trial_moments};
use sistership_regression::Moments;

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

impl TrialStatistics {
    /// Of a trial, in a frame.
    ///
    /// # Errors
    /// Names the channel that the trial lacks.
    pub fn of(frame: &Frame, trial: &Trial) -> Result<Self, RefineError> {
        let moments = trial_moments(&frame.blocks, trial, Some(frame.difference_s))?;
        let regressions = frame.blocks.blocks.iter().zip(moments).map(|(block, moments)| Regression::of(block, moments));
        Ok(Self { format: FORMAT.to_owned(), duration_s: trial.duration_s(), regressions: regressions.collect() })
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
        if self.regressions.iter().all(Regression::is_whole) { Ok(()) } else { refuse("lists and numbers do not go together") }
    }

    /// Whether two trials were regressed in the same frame, so that their statistics may be added.
    pub fn goes_with(&self, other: &Self) -> bool {
        let same = |(a, b): (&Regression, &Regression)| (&a.axes, &a.names, &a.mixing) == (&b.axes, &b.names, &b.mixing);
        self.regressions.len() == other.regressions.len() && self.regressions.iter().zip(&other.regressions).all(same)
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
        mixing.try_inverse().ok_or_else(|| RefineError::Data("the statistics mix axes that cannot be told apart".into()))
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
}

#[cfg(test)]
mod tests;
