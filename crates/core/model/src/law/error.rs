//! Error of a coefficient for which a law has no term.

use crate::coefficient::{Axis, NameError};
use sistership_formula::FormulaError;

/// Reason for which a law has no term for a coefficient.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TermError {
    /// The name is not one of a coefficient.
    #[error(transparent)]
    Name(#[from] NameError),
    /// The law has no such axis.
    #[error("law `{law}` has no {axis} axis")]
    Axis {
        /// The law.
        law: String,
        /// The axis.
        axis: Axis,
    },
    /// The law lists the terms of the axis, and the coefficient is not among them.
    #[error("law `{law}` has no coefficient `{name}`; it has {known}")]
    Unlisted {
        /// The law.
        law: String,
        /// The coefficient.
        name: String,
        /// Coefficients of the axis.
        known: String,
    },
    /// The law does not define a factor.
    #[error("law `{law}` does not define the factor `{symbol}`")]
    Factor {
        /// The law.
        law: String,
        /// The factor.
        symbol: String,
    },
    /// The law has no such submodel.
    #[error("law `{law}` has no submodel `{submodel}`; it has {known}")]
    Submodel {
        /// The law.
        law: String,
        /// The submodel.
        submodel: String,
        /// Submodels of the law.
        known: String,
    },
    /// The dimension of the regressor cannot be determined.
    #[error(transparent)]
    Dimension(#[from] FormulaError),
}
