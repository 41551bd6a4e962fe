//! Refinement from the stored statistics of trials, for whole fleets: the published ridge about a prior over the full path of
//! strengths, chosen by the errors on trials left out, without a sample read.

mod chosen;
mod group;
mod outcome;
mod prior;
mod refine;
mod report;
mod sails;
mod settings;
mod solved;

pub use outcome::{AxisOutcome, BulkRefinement, Coefficient};
pub use prior::{AxisPrior, Prior};
pub use refine::{BulkRequest, refine, refined_model};
pub use sails::{Sailed, sail};
pub use settings::BulkSettings;
pub use solved::{Solved, solve};

#[cfg(test)]
mod tests;
