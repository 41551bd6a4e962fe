//! How much more a champion leaves of its newest trials than of those that it was fitted on.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The ratio above which a champion does not hold, dimensionless: it leaves twice as much of new
/// trials, so that three quarters of what is left of them, by its square, are new. Webhooks tell of
/// the same one where they name none.
pub const DRIFT_LIMIT: f64 = 2.0;

/// Drift of a champion over the newest trials since it was fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RecentDrift {
    /// Root mean square of what is left of the force on them, by that on the trials it was fitted
    /// on.
    pub ratio: f64,
    /// The axis with the largest ratio.
    pub axis: String,
    /// The id of the first trial of which as much is left, where the ratio is above its limit.
    pub since: Option<String>,
}

impl RecentDrift {
    /// Whether the champion does not hold by it.
    pub fn is_above_limit(&self) -> bool {
        self.ratio > DRIFT_LIMIT
    }
}
