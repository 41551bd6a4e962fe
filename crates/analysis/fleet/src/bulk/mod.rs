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

pub use outcome::{AxisOutcome, BulkRefinement, CoefficientOutcome};
pub use prior::{AxisPrior, BulkPrior};
pub use refine::{refine_ship, refined_model, with_balance};
pub use request::BulkRequest;
pub use sails::{ManoeuvreFigures, simulate_check};
pub use settings::BulkSettings;
pub use solved::{ShipRidgePath, solve_path};

#[cfg(test)]
mod tests;
