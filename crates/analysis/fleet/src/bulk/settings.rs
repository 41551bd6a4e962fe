//! Settings of refinements from statistics.

use serde::{Deserialize, Serialize};

use sistership_identification::refine::RefineError;

/// Settings of refinements from statistics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BulkSettings {
    /// Number of strengths of the prior on the path.
    #[schemars(range(min = 2, max = 1000))]
    pub lambda_count: usize,
    /// Weakest prior; for a family's prior, the factor by which it is tighter than learned.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lambda_min: f64,
    /// Strongest prior, in the same measure.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lambda_max: f64,
    /// Time over which accelerations are differenced, s. Default: a tenth of the time in which the
    /// ship travels its length.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub difference_s: Option<f64>,
}

impl Default for BulkSettings {
    fn default() -> Self {
        Self { lambda_count: 100, lambda_min: 1e-6, lambda_max: 1e10, difference_s: None }
    }
}

impl BulkSettings {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Returns an error that names the field and its valid values.
    pub fn check(&self) -> Result<(), RefineError> {
        let refuse = |field: &str, message: &str| {
            Err(RefineError::Setting { field: field.into(), message: message.into() })
        };
        if !(2..=1000).contains(&self.lambda_count) {
            return refuse("lambda_count", "must be from 2 to 1000");
        }
        if !(self.lambda_min > 0.0
            && self.lambda_min < self.lambda_max
            && self.lambda_max.is_finite())
        {
            return refuse("lambda_min", "must be above 0 and below lambda_max");
        }
        if !self.difference_s.is_none_or(|s| s > 0.0 && s.is_finite()) {
            return refuse("difference_s", "must be above 0 s");
        }
        Ok(())
    }

    /// Strengths of the path, evenly spaced in their logarithm.
    pub(super) fn strength_path(&self) -> Vec<f64> {
        let (low, high) = (self.lambda_min.ln(), self.lambda_max.ln());
        // Linear in the logarithm, from the minimum to the maximum.
        let at = |k: usize| (low + (high - low) * k as f64 / (self.lambda_count - 1) as f64).exp();
        (0..self.lambda_count).map(at).collect()
    }

    /// Number of strengths per factor of ten.
    pub(super) fn strengths_per_decade(&self) -> f64 {
        (self.lambda_count - 1) as f64 / (self.lambda_max / self.lambda_min).log10()
    }
}
