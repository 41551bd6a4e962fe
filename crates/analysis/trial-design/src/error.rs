//! Errors of a trial design.

use sistership_identification::refine::RefineError;
use sistership_model::triangle::TriangleError;
use sistership_simulation::PlantError;

/// Error of a trial design.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The budget is zero, negative or too long.
    #[error("the budget must be above 0 and at most a day")]
    Budget,
    /// The budget is shorter than any trial.
    #[error(
        "no trial fits into {budget_min:.0} min: the shortest takes {shortest_min:.0} min; \
             increase the budget"
    )]
    NoTrialFits {
        /// Budget, min.
        budget_min: f64,
        /// Duration of the shortest trial, min.
        shortest_min: f64,
    },
    /// The library has no such effect.
    #[error("there is no effect `{name}`; choose one of {}", known.join(", "))]
    Effect {
        /// Requested name.
        name: String,
        /// Names in the library.
        known: Vec<String>,
    },
    /// The ship cannot carry out any manoeuvre.
    #[error("{model} completes none of the possible trials: {reason}")]
    SailsNone {
        /// Name of the model.
        model: String,
        /// Reason of a failure.
        reason: String,
    },
    /// No figure depends on the unknowns.
    #[error(
        "there is no uncertainty to reduce: no figure of the standard manoeuvres depends on the \
         uncertain coefficients of {0}"
    )]
    NothingOpen(String),
    /// The law has no rudder.
    #[error("law `{0}` has no rudder angle as input, so that no trial can be designed")]
    NoRudder(String),
    /// The model cannot be simulated.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The posterior cannot be read.
    #[error("posterior: {0}")]
    Posterior(#[from] TriangleError),
    /// The information cannot be computed.
    #[error(transparent)]
    Information(#[from] RefineError),
}
