//! Errors of limits that cannot be set up or kept.

use clarabel::solver::SolverStatus;
use sistership_simulation::PlantError;

use super::settings::StraightLine;

/// The error type for limits of the coefficients that cannot be set up, or are not kept.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LimitError {
    /// Bounds of a coefficient that the model does not have.
    #[error("bounds.{0}: the model has no such coefficient")]
    Unknown(String),
    /// The model cannot be set up for simulation.
    #[error(transparent)]
    Model(#[from] PlantError),
    /// A coefficient of the limits is not one of the solution.
    #[error("constraints: a constrained coefficient was not fitted")]
    NotFitted,
    /// Limits that exclude each other, none of which can be left out, by name.
    #[error("these constraints contradict each other: {}", .0.join("; "))]
    Conflict(Vec<String>),
    /// The solver found no solution.
    #[error("constraints: the solver ended with {0:?}")]
    Solver(SolverStatus),
    /// A model breaks the limit of that name.
    #[error("it violates the constraint `{0}`")]
    Broken(String),
    /// A model does not have the declared straight-line stability.
    #[error(
        "it is not straight-line {}",
        if *.0 == StraightLine::Stable { "stable" } else { "unstable" }
    )]
    StraightLine(StraightLine),
}
