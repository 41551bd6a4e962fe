//! What holds the coefficients of a refinement.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::settings::BulkSettings;

/// A prior of every axis.
#[derive(Debug, Clone, Copy)]
pub enum Prior<'a> {
    /// One source's coefficients, each held in standard deviations of its regressor (Kanazawa 2023,
    /// Eq. 5.11).
    Source(&'a BTreeMap<String, f64>),
    /// A mean and a covariance for each axis, as learned over a family.
    Family {
        /// By axis.
        axes: &'a [AxisPrior],
        /// How many samples count as one.
        design_effect: f64,
    },
}

/// The prior of one axis: normal in the values of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisPrior {
    /// The coefficients, in order.
    pub names: Vec<String>,
    /// Their mean.
    pub mean: Vec<f64>,
    /// A root of their covariance: `root root'`.
    pub root: DMatrix<f64>,
}

impl Prior<'_> {
    /// Means of an axis' coefficients.
    pub(super) fn means(&self, names: &[String]) -> Option<Vec<f64>> {
        match self {
            Self::Source(source) => {
                Some(names.iter().map(|name| source.get(name).copied().unwrap_or(0.0)).collect())
            }
            Self::Family { .. } => self.of_axis(names).map(|axis| axis.mean.clone()),
        }
    }

    /// The learned prior of an axis with these coefficients.
    pub(super) fn of_axis(&self, names: &[String]) -> Option<&AxisPrior> {
        match self {
            Self::Source(_) => None,
            Self::Family { axes, .. } => axes.iter().find(|axis| axis.names == names),
        }
    }

    /// A learned covariance is an upper limit: trials that resemble each other would always take a
    /// weaker prior, since leaving one out asks nothing that the others do not tell.
    pub(super) fn allows(&self, settings: &BulkSettings) -> BulkSettings {
        match self {
            Self::Source(_) => *settings,
            Self::Family { .. } => BulkSettings {
                lambda_min: settings.lambda_min.max(1.0).min(0.1 * settings.lambda_max),
                ..*settings
            },
        }
    }
}
