//! What is asked of a refinement from statistics.

use sistership_model::{Law, Model};

use super::prior::Prior;
use super::settings::BulkSettings;
use crate::statistics::TrialStatistics;

/// A ship to be refined from statistics.
#[derive(Debug, Clone, Copy)]
pub struct BulkRequest<'a> {
    /// Its model; it gives everything but the coefficients.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
    /// The statistics of its trials, in the model's frame.
    pub trials: &'a [TrialStatistics],
    /// What holds the coefficients.
    pub prior: Prior<'a>,
    /// Settings.
    pub settings: &'a BulkSettings,
}
