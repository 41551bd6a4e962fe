//! Sufficient statistics of a trial as a document: all that a regression needs of its samples, so
//! that a ship is refined again, with another prior or another trial, without reading samples.
//!
//! They depend on the trial and on everything that determines the rows: law, particulars,
//! parameters, names of the coefficients and the time over which accelerations are differenced. The
//! key of a frame is a hash over all of it.

mod correction_additions;
mod frame;
mod packed;
mod trial_statistics;

pub use frame::{FORMAT, RegressionFrame};
pub use trial_statistics::{AxisResidual, RegressionStatistics, TrialStatistics};

#[cfg(test)]
mod tests;
