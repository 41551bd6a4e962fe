//! Input of a refinement from statistics.

use sistership_model::{Law, Model};

use super::prior::BulkPrior;
use super::settings::BulkSettings;
use crate::statistics::TrialStatistics;

/// Ship to be refined from statistics.
#[derive(Debug, Clone, Copy)]
pub struct BulkRequest<'a> {
    /// Model before; it gives everything except the coefficients.
    pub model: &'a Model,
    /// Law of the model.
    pub law: &'a Law,
    /// Statistics of the trials, in the model's frame.
    pub trials: &'a [TrialStatistics],
    /// Prior of the coefficients.
    pub prior: BulkPrior<'a>,
    /// Settings of the refinement.
    pub settings: &'a BulkSettings,
}
