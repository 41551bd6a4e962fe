//! Errors of formulas.

use crate::syntax::Function;
use crate::units::Dimension;

/// Error of a formula.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FormulaError {
    /// The formula is too long to be parsed.
    #[error("a formula of {length} characters; the limit is {most}: define parts of it as values")]
    Long {
        /// Length, bytes.
        length: usize,
        /// Largest length, bytes.
        most: usize,
    },
    /// The formula nests too deep to be parsed.
    #[error(
        "formula `{head}...` nests {found} parentheses, signs and powers; the limit is {most}: \
         define parts of it as values"
    )]
    Nested {
        /// Beginning of the formula.
        head: String,
        /// Nesting depth.
        found: usize,
        /// Largest nesting depth.
        most: usize,
    },
    /// The formula has too many operators.
    #[error(
        "formula `{head}...` has {found} operators; the limit is {most}: define parts of it as \
         values"
    )]
    Operators {
        /// Beginning of the formula.
        head: String,
        /// Number of operators.
        found: usize,
        /// Largest number of operators.
        most: usize,
    },
    /// The formula cannot be read from some place on.
    #[error("formula `{formula}` cannot be read from {place}{expected}")]
    Syntax {
        /// The formula.
        formula: String,
        /// The place.
        place: String,
        /// The expected input at that place, if known.
        expected: String,
    },
    /// The text is not a condition.
    #[error("condition `{0}` cannot be read: write `u < 0`")]
    Condition(String),
    /// A condition without a comparison.
    #[error("condition `{0}` lacks a comparison: write `u < 0`")]
    Comparison(String),
    /// An unknown name.
    #[error("unknown name `{0}`")]
    Name(String),
    /// An exponent has a dimension.
    #[error("an exponent must be a pure number, not {0}")]
    Exponent(Dimension),
    /// A quantity with a dimension is raised to an exponent that is not a number.
    #[error("{0} can only be raised to a number, not to a formula")]
    Power(Dimension),
    /// A function has an argument with a dimension.
    #[error("{function:?} needs a pure number or an angle, not {found}")]
    Argument {
        /// The function.
        function: Function,
        /// Dimension of the argument.
        found: Dimension,
    },
    /// The two sides of a sum or a comparison do not agree.
    #[error("adds or compares {0} with {1}")]
    Sides(Dimension, Dimension),
    /// A formula that should be a number uses a name.
    #[error("`{formula}` should be a number but contains the name `{name}`")]
    NotConstant {
        /// The formula.
        formula: String,
        /// The name.
        name: String,
    },
    /// The formula has no finite value.
    #[error("`{0}` has no finite value")]
    NotFinite(String),
}
