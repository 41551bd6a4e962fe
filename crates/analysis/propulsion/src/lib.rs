//! Propulsion of a model where its trials do not reach: the surge balance that it is given, and
//! what a ship must do when her propeller is stopped or reversed.

mod balance;
mod check;
mod context;
mod covered;
mod slope;
mod thresholds;

pub use balance::{Evidence, balance, needs_balance};
pub use check::{PropulsionFault, check, check_turning};
pub use context::{Context, words};
