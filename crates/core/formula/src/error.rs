//! What is wrong with a formula.

use crate::syntax::Function;
use crate::units::Dimension;

/// What is wrong with a formula.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FormulaError {
    /// It is too long to be parsed.
    #[error("a formula of {length} characters; {most} are the most: write parts of it as values")]
    Long {
        /// Its bytes.
        length: usize,
        /// Most bytes.
        most: usize,
    },
    /// It nests too deep to be parsed.
    #[error(
        "formula `{head}...` nests {found} parentheses, signs and powers; {most} are the most: \
         write parts of it as values"
    )]
    Nested {
        /// How it begins.
        head: String,
        /// How deep it nests.
        found: usize,
        /// How deep it may.
        most: usize,
    },
    /// It has too many operators.
    #[error(
        "formula `{head}...` has {found} operators; {most} are the most: write parts of it as \
         values"
    )]
    Operators {
        /// How it begins.
        head: String,
        /// How many it has.
        found: usize,
        /// How many it may have.
        most: usize,
    },
    /// It stops making sense at a place.
    #[error("formula `{formula}` cannot be read from {place}{expected}")]
    Syntax {
        /// The formula.
        formula: String,
        /// The place.
        place: String,
        /// What was expected there, where that can be told.
        expected: String,
    },
    /// It is no condition.
    #[error("condition `{0}` cannot be read: write `u < 0`")]
    Condition(String),
    /// A condition compares nothing.
    #[error("condition `{0}` lacks a comparison: write `u < 0`")]
    Comparison(String),
    /// It mentions what it may not.
    #[error("unknown name `{0}`")]
    Name(String),
    /// An exponent has a dimension.
    #[error("an exponent must be a pure number, not {0}")]
    Exponent(Dimension),
    /// What has a dimension is raised to what is not known.
    #[error("{0} can only be raised to a number, not to a formula")]
    Power(Dimension),
    /// A function is given what has a dimension.
    #[error("{function:?} needs a pure number or an angle, not {found}")]
    Argument {
        /// The function.
        function: Function,
        /// What it is given.
        found: Dimension,
    },
    /// The two sides of a sum or a comparison do not go together.
    #[error("adds or compares {0} with {1}")]
    Sides(Dimension, Dimension),
    /// What should be a number mentions a name.
    #[error("`{formula}` should be a number but mentions `{name}`")]
    NotConstant {
        /// The formula.
        formula: String,
        /// The name.
        name: String,
    },
    /// It has no value.
    #[error("`{0}` has no finite value")]
    NotFinite(String),
}
