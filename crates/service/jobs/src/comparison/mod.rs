//! Comparison of two to five models: coefficients, errors on the same trials, standard manoeuvres
//! and criteria.

mod coefficients;
mod compare;
mod comparison_model;
mod manoeuvres;
pub mod stored;
#[cfg(test)]
mod tests;
mod trials;

pub use coefficients::{ComparedCoefficient, Estimate};
pub use compare::{
    Column, Comparison, ComparisonError, MODEL_COUNT_LIMITS, MOST_TRIALS, check_names, compare,
};
pub use comparison_model::ComparisonModel;
pub use manoeuvres::{ComparedFigure, FigureValue};
pub use trials::{ComparedTrial, TrialError};
