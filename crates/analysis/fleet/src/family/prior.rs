//! What a family teaches, as a document.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;

use crate::bulk::AxisPrior;

/// The format of [`FamilyPrior`].
pub const FORMAT: &str = "sistership-family-prior/1";

/// Mean and covariance of the coefficients of a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyPrior {
    /// Always [`FORMAT`].
    pub format: String,
    /// The members whose trials it was learned from, in order.
    pub members: Vec<String>,
    /// How many samples count as one, since neighbours say the same: from the scatter between the
    /// trials of a ship.
    pub design_effect: f64,
    /// How much of the correlations between coefficients is kept: few members cannot tell them.
    pub correlations_kept: f64,
    /// Steps of expectation and maximisation.
    pub steps: usize,
    /// Every axis.
    pub axes: Vec<FamilyAxis>,
}

/// The coefficients of one axis over a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyAxis {
    /// The axis.
    pub axis: Axis,
    /// Its coefficients, in order.
    pub names: Vec<String>,
    /// Their means.
    pub mean: Vec<f64>,
    /// By how much members differ: standard deviations.
    pub deviation: Vec<f64>,
    /// How the differences of two coefficients go together, by row.
    pub correlation: Vec<Vec<f64>>,
    /// How much of a member's own difference its trials tell, in the mean over the members: 0 where
    /// the family decides alone, 1 where its trials do.
    pub told_by_trials: Vec<f64>,
}

/// Why a document is no prior.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FamilyPriorError {
    /// The lists of an axis do not go together.
    #[error("axis {0}: names, means, deviations and correlations are not equally many")]
    Lengths(Axis),
    /// What an axis has for correlations is no correlation matrix.
    #[error("axis {0}: the correlations are none")]
    Correlations(Axis),
}

impl FamilyPrior {
    /// The priors of the axes, for [`crate::bulk::Prior::Family`].
    ///
    /// # Errors
    /// Names the axis whose correlations are none.
    pub fn axes(&self) -> Result<Vec<AxisPrior>, FamilyPriorError> {
        self.axes.iter().map(FamilyAxis::prior).collect()
    }
}

impl FamilyAxis {
    fn prior(&self) -> Result<AxisPrior, FamilyPriorError> {
        let p = self.names.len();
        let long = |length: usize| length == p;
        let whole =
            long(self.mean.len()) && long(self.deviation.len()) && long(self.correlation.len());
        if !whole || !self.correlation.iter().all(|row| long(row.len())) {
            return Err(FamilyPriorError::Lengths(self.axis));
        }
        // In units of the deviations, which differ by orders of magnitude.
        let correlation = DMatrix::from_fn(p, p, |i, j| self.correlation[i][j]);
        let root =
            correlation.cholesky().ok_or(FamilyPriorError::Correlations(self.axis))?.unpack();
        let root = DMatrix::from_fn(p, p, |i, j| self.deviation[i] * root[(i, j)]);
        Ok(AxisPrior { names: self.names.clone(), mean: self.mean.clone(), root })
    }
}
