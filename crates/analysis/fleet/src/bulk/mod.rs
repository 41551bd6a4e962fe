//! Refinement from the stored statistics of trials, for whole fleets: the published ridge about a
//! prior over the full path of strengths, selected by the errors on held-out trials, without
//! reading samples.

mod group;
mod manoeuvre_check;
mod outcome;
mod prior;
mod refine;
mod report;
mod request;
mod ridge_path;
mod settings;
mod strength_selection;

pub use manoeuvre_check::{ManoeuvreFigures, simulate_check};
pub use outcome::{AxisOutcome, BulkRefinement, CoefficientOutcome};
pub use prior::{AxisPrior, BulkPrior};
pub use refine::{refine_ship, refined_model, with_balance};
pub use request::BulkRequest;
pub use ridge_path::{ShipRidgePath, solve_path};
pub use settings::BulkSettings;

#[cfg(test)]
mod tests;
