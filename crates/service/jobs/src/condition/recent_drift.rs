//! Drift: unexplained force on the newest trials relative to the trials that a champion was fitted
//! on.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Ratio above which a champion is not valid, dimensionless: the unexplained force on new trials is
/// twice as large, so that three quarters of its square are new. Webhooks use the same limit by
/// default.
pub const DRIFT_LIMIT: f64 = 2.0;

/// Drift of a champion over the newest trials since it was fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RecentDrift {
    /// Root mean square of the unexplained force on them, divided by that on the trials it was
    /// fitted on.
    pub ratio: f64,
    /// The axis with the largest ratio.
    pub axis: String,
    /// The id of the first trial above the limit, if the ratio is above it.
    pub since: Option<String>,
}

impl RecentDrift {
    /// Returns true if the drift alone makes the champion invalid.
    pub fn is_above_limit(&self) -> bool {
        self.ratio > DRIFT_LIMIT
    }
}
