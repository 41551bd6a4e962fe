//! Prior from a family as a document.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use sistership_model::coefficient::Axis;

use crate::bulk::AxisPrior;

/// Format of [`FamilyPrior`].
pub const FORMAT: &str = "sistership-family-prior/1";

/// Mean and covariance of the coefficients of a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyPrior {
    /// Always [`FORMAT`].
    pub format: String,
    /// Members whose trials it was learned from, in order.
    pub members: Vec<String>,
    /// Number of samples that count as one, since neighbouring samples are correlated: from the
    /// scatter between the trials of a ship.
    pub design_effect: f64,
    /// Share of the correlations between coefficients that is kept: few members cannot determine
    /// them.
    pub correlations_kept: f64,
    /// Number of steps of expectation and maximisation.
    pub steps: usize,
    /// All axes.
    pub axes: Vec<FamilyAxis>,
}

/// Coefficients of one axis over a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyAxis {
    /// Axis of the coefficients.
    pub axis: Axis,
    /// Names of the coefficients, in order.
    pub names: Vec<String>,
    /// Means of the coefficients.
    pub mean: Vec<f64>,
    /// Standard deviations over the members.
    pub deviation: Vec<f64>,
    /// Correlations of the coefficients over the members, by row.
    pub correlation: Vec<Vec<f64>>,
    /// Share of a member's own deviation that its trials determine, averaged over the members: 0 if
    /// the family decides alone, 1 if the trials do.
    pub told_by_trials: Vec<f64>,
}

/// Error of a document that is not a valid prior.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FamilyPriorError {
    /// The lists of an axis differ in length.
    #[error("axis {0}: names, means, deviations and correlations differ in number")]
    Lengths(Axis),
    /// The correlations of an axis are not a correlation matrix.
    #[error("axis {0}: the correlations are not a correlation matrix")]
    Correlations(Axis),
}

impl FamilyPrior {
    /// Priors of the axes, for a refinement in bulk.
    ///
    /// # Errors
    /// Returns an error that names the axis whose lists or correlations are invalid.
    pub fn axis_priors(&self) -> Result<Vec<AxisPrior>, FamilyPriorError> {
        self.axes.iter().map(FamilyAxis::axis_prior).collect()
    }
}

impl FamilyAxis {
    /// Prior of this axis.
    fn axis_prior(&self) -> Result<AxisPrior, FamilyPriorError> {
        let p = self.names.len();
        let long = |length: usize| length == p;
        // Lists from a document may have any length.
        let whole =
            long(self.mean.len()) && long(self.deviation.len()) && long(self.correlation.len());
        if !whole || !self.correlation.iter().all(|row| long(row.len())) {
            return Err(FamilyPriorError::Lengths(self.axis));
        }
        // Decomposed in units of the deviations, which differ by orders of magnitude.
        let correlation = DMatrix::from_fn(p, p, |i, j| self.correlation[i][j]);
        let root =
            correlation.cholesky().ok_or(FamilyPriorError::Correlations(self.axis))?.unpack();
        let root = DMatrix::from_fn(p, p, |i, j| self.deviation[i] * root[(i, j)]);
        Ok(AxisPrior { names: self.names.clone(), mean: self.mean.clone(), root })
    }
}
