//! Accelerations that no coefficient explains.

use sistership_model::uncertainty::Discrepancy;

/// Discrepancy of each acceleration, in the order of the filter's axes.
pub type AxisDiscrepancies = Vec<Discrepancy>;
