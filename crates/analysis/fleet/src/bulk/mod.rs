//! Refinement from the stored statistics of trials, for whole fleets: the published ridge about a
//! prior over the full path of strengths, selected by the errors on held-out trials, without
//! reading samples.

mod chosen;
mod group;
mod outcome;
mod prior;
mod refine;
mod report;
mod request;
mod sails;
mod settings;
mod solved;

pub use outcome::{AxisOutcome, BulkRefinement, Coefficient};
pub use prior::{AxisPrior, Prior};
pub use refine::{refine, refined_model, with_balance};
pub use request::BulkRequest;
pub use sails::{SailedFigures, sail};
pub use settings::BulkSettings;
pub use solved::{SolvedPath, solve};

#[cfg(test)]
mod tests;
