//! Error type of the equations of motion.

use sistership_formula::FormulaError;
use sistership_model::law::TermError;

/// Reason for which a model cannot be prepared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A formula needs a particular or parameter that the model does not have.
    #[error("law `{law}` needs `{name}`, which the model `{model}` lacks; add it")]
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
    /// The mass matrix depends on the motion, but would have to be differentiated.
    #[error(
        "the masses of law `{0}` change with the motion, for which sensitivities are not \
             available"
    )]
    MovingMass(String),
    /// A view that can represent neither lags nor instruments.
    #[error(
        "`{model}` has a lag, a dead band or an effect on instruments, for which {view} are \
             not available"
    )]
    Unsupported {
        /// The model.
        model: String,
        /// The view that is not available.
        view: &'static str,
    },
    /// A law has more inputs than a simulation can give.
    #[error("law `{law}` has more than {most} inputs")]
    Inputs {
        /// The law.
        law: String,
        /// Most inputs.
        most: usize,
    },
    /// The weights of the model's learned correction are not attached.
    #[error("branch: `{model}` has a learned correction whose weights {sha256} are missing")]
    Weights {
        /// The model.
        model: String,
        /// The hash of the weights.
        sha256: String,
    },
    /// A request that only the foundation of a model with a learned correction can answer.
    #[error(
        "branch: `{0}` has a learned correction, which has no formulas and no coefficients: use \
         the model without it"
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
        /// Description of the error.
        message: String,
    },
}
