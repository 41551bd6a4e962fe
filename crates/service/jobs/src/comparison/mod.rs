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
pub use compared::Compared;
pub use manoeuvres::{ComparedFigure, FigureValue};
pub use side_by_side::{BETWEEN, Column, Comparison, ComparisonError, MOST_TRIALS, check, compare};
pub use trials::{ComparedTrial, TrialError};
