//! Formulas without names.

use crate::error::FormulaError;
use crate::parse::parse;

/// Evaluates a formula without names, such as `0.605/304.8`.
///
/// # Errors
/// Returns the fault of the formula, or the name that it should not use.
pub fn evaluate_constant(text: &str) -> Result<f64, FormulaError> {
    let expr = parse(text)?;
    let value = expr.value(&|_| None);
    value.filter(|v| v.is_finite()).ok_or_else(|| match expr.mentioned_names().first() {
        Some(name) => {
            FormulaError::NotConstant { formula: text.to_owned(), name: (*name).to_owned() }
        }
        None => FormulaError::NotFinite(text.to_owned()),
    })
}
