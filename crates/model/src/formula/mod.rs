//! Formulas of laws and effects: parsed once, checked for units, lowered later by the dynamics.

mod constant;
mod dimension;
mod error;
mod limits;
mod parse;
mod syntax;

pub use constant::constant;
pub use dimension::dimension_of;
pub use error::FormulaError;
pub(crate) use limits::head;
pub use limits::{MAX_DEPTH, MAX_LENGTH, MAX_NESTING, MAX_OPERATORS};
pub use parse::{parse, parse_condition};
pub use syntax::{Comparison, Expr, Function, builtin};
