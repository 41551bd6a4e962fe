//! Propulsion of a model outside the range of its trials: its surge balance, and the checks with a
//! stopped or reversed propeller.

mod balance;
mod check;
mod context;
mod covered;
mod slope;
mod straight_surge;
mod thresholds;
mod waves;

pub use balance::{PropulsionEvidence, SourcePropeller, model_balance, needs_balance};
pub use check::{PropulsionFault, check_straight, check_turning};
pub use context::{PropulsionContext, describe_balance};
