//! Formulas of laws and effects: parsed once, checked for units, and lowered by the simulation.
//!
//! No ships and no files: text goes in, an expression or an error comes out.

mod constant;
mod dimension;
mod error;
mod limits;
mod parse;
mod syntax;
pub mod units;

pub use constant::evaluate_constant;
pub use dimension::dimension_of;
pub use error::FormulaError;
pub use limits::{MAX_DEPTH, MAX_LENGTH, MAX_NESTING, MAX_OPERATORS, text_head};
pub use parse::{parse, parse_condition};
pub use syntax::{Comparison, Expr, Function, builtin_constant};
