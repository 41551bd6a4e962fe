//! Why the equations of motion cannot be used.

use sistership_formula::FormulaError;
use sistership_model::law::TermError;

/// Why a model cannot be made ready.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A formula needs a particular or parameter that the model does not have.
    #[error("law `{law}` needs `{name}`, which the model `{model}` does not give")]
    Missing {
        /// The law.
        law: String,
        /// The name without a value.
        name: String,
        /// The model.
        model: String,
    },
    /// The mass matrix cannot be solved.
    #[error(
        "the mass matrix of `{0}` is singular or not positive: check mass, inertia and added masses"
    )]
    Mass(String),
    /// The mass matrix depends on the motion, and is to be differentiated.
    #[error("masses of law `{0}` change with the motion: no sensitivities")]
    MovingMass(String),
    /// Some view knows neither lags nor instruments.
    #[error("`{model}` carries a lag, a dead band or an effect on instruments: no {view}")]
    Unsupported {
        /// The model.
        model: String,
        /// What is not to be had.
        view: &'static str,
    },
    /// A law takes more from outside than a simulation can give.
    #[error("law `{law}` has more than {most} inputs")]
    Inputs {
        /// The law.
        law: String,
        /// Most inputs.
        most: usize,
    },
    /// A model with a learned branch is sailed without its weights.
    #[error("branch: `{model}` has a learned branch, whose weights {sha256} are not here")]
    Weights {
        /// The model.
        model: String,
        /// The hash of the weights.
        sha256: String,
    },
    /// What is asked of a model with a learned branch can only be asked of its foundation.
    #[error(
        "branch: `{0}` has a learned branch, which has no formulas and no coefficients: give the \
         model that it was trained on"
    )]
    Branch(String),
    /// The law has no such coefficient.
    #[error(transparent)]
    Term(#[from] TermError),
    /// A formula cannot be read.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// An effect that the model carries cannot be used.
    #[error("{field}: {message}")]
    Effect {
        /// The field of the model.
        field: String,
        /// What is wrong with it.
        message: String,
    },
}
