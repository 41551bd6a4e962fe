//! Priors of the coefficients of a refinement.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::settings::BulkSettings;

/// Prior of all axes.
#[derive(Debug, Clone, Copy)]
pub enum BulkPrior<'a> {
    /// Coefficients of one source, measured in standard deviations of their regressors (Kanazawa
    /// 2023, Eq. 5.11).
    Source(&'a BTreeMap<String, f64>),
    /// Mean and covariance of each axis, learned over a family.
    Family {
        /// Priors of the axes.
        axes: &'a [AxisPrior],
        /// Number of samples that count as one.
        design_effect: f64,
    },
}

/// Prior of one axis: normal in the values of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisPrior {
    /// Names of the coefficients, in order.
    pub names: Vec<String>,
    /// Mean of the coefficients.
    pub mean: Vec<f64>,
    /// Root of their covariance: `root root'`.
    pub root: DMatrix<f64>,
}

impl BulkPrior<'_> {
    /// Means of an axis' coefficients. Returns `None` if the family has no such axis.
    pub(super) fn prior_means(&self, names: &[String]) -> Option<Vec<f64>> {
        match self {
            Self::Source(source) => {
                // A coefficient that the source lacks has a prior mean of zero.
                Some(names.iter().map(|name| source.get(name).copied().unwrap_or(0.0)).collect())
            }
            Self::Family { .. } => self.axis_prior(names).map(|axis| axis.mean.clone()),
        }
    }

    /// Returns the learned prior of the axis with these coefficients.
    pub(super) fn axis_prior(&self, names: &[String]) -> Option<&AxisPrior> {
        match self {
            Self::Source(_) => None,
            Self::Family { axes, .. } => axes.iter().find(|axis| axis.names == names),
        }
    }

    /// Limits the strengths to those that the prior allows. A learned covariance is an upper limit:
    /// trials that resemble each other would always select a weaker prior, since each is predicted
    /// well by the others.
    pub(super) fn limit_settings(&self, settings: &BulkSettings) -> BulkSettings {
        match self {
            Self::Source(_) => *settings,
            Self::Family { .. } => BulkSettings {
                // Strength 1 is the learned covariance; the minimum stays below the maximum of the
                // path.
                lambda_min: settings.lambda_min.max(1.0).min(0.1 * settings.lambda_max),
                ..*settings
            },
        }
    }
}
