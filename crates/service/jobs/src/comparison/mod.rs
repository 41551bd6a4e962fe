//! Comparison of two to five models: coefficients, errors on the same trials, standard manoeuvres
//! and criteria.

mod coefficients;
mod compared;
mod manoeuvres;
mod side_by_side;
pub mod stored;
#[cfg(test)]
mod tests;
mod trials;

pub use coefficients::{ComparedCoefficient, Estimate};
pub use compared::ComparisonModel;
pub use manoeuvres::{ComparedFigure, FigureValue};
pub use side_by_side::{
    Column, Comparison, ComparisonError, MODEL_COUNT_LIMITS, MOST_TRIALS, check_names, compare,
};
pub use trials::{ComparedTrial, TrialError};
