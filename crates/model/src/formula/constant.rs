//! Formulas of numbers alone.

use super::parse::parse;

/// The value of a formula without names, such as `0.605/304.8`.
///
/// # Errors
/// Says what is wrong with the formula, or which name it should not mention.
pub fn constant(text: &str) -> Result<f64, String> {
    let expr = parse(text)?;
    let value = expr.value(&|_| None);
    value.filter(|v| v.is_finite()).ok_or_else(|| match expr.names().first() {
        Some(name) => format!("`{text}` should be a number but mentions `{name}`"),
        None => format!("`{text}` has no finite value"),
    })
}
