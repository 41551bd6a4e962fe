//! Propulsion of a model outside the range of its trials: its surge balance, and the checks with a
//! stopped or reversed propeller.

mod balance;
mod check;
mod context;
mod covered;
mod slope;
mod thresholds;

pub use balance::{Evidence, balance, needs_balance};
pub use check::{PropulsionFault, check, check_turning};
pub use context::{Context, words};
