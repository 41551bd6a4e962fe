//! Formulas of laws and effects: parsed once, checked for units, lowered later by the dynamics.

mod dimension;
mod parse;
mod syntax;

pub use dimension::dimension_of;
pub use parse::{parse, parse_condition};
pub use syntax::{Comparison, Expr, Function, builtin, constant};
