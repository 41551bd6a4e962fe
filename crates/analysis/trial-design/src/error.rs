//! Why there is no plan.

use sistership_identification::refine::RefineError;
use sistership_model::triangle::TriangleError;
use sistership_simulation::PlantError;

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The budget is no time.
    #[error("the budget must be above 0 and at most a day")]
    Budget,
    /// The budget is shorter than any trial.
    #[error("no trial fits into {budget_min:.0} min: the shortest takes {shortest_min:.0} min")]
    NoTrialFits {
        /// What there is, min.
        budget_min: f64,
        /// What is needed, min.
        shortest_min: f64,
    },
    /// The library has no such effect.
    #[error("no effect `{name}`; there are {}", known.join(", "))]
    Effect {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// No manoeuvre can be sailed.
    #[error("{model} sails none of the manoeuvres that could be planned: {reason}")]
    SailsNone {
        /// The model.
        model: String,
        /// Why the last of them failed.
        reason: String,
    },
    /// Nothing is uncertain.
    #[error(
        "nothing is to be narrowed: no figure of the standard manoeuvres changes with the \
         coefficients of {0}"
    )]
    NothingOpen(String),
    /// The law has no rudder.
    #[error("law `{0}` takes no rudder angle: there is nothing to steer")]
    NoRudder(String),
    /// The model does not sail.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// Its posterior does not read.
    #[error("posterior: {0}")]
    Posterior(#[from] TriangleError),
    /// Nothing can be learned of it.
    #[error(transparent)]
    Information(#[from] RefineError),
}
