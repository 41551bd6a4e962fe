//! Numbers for people, with the decimal mark of the language. What programs read keeps the point.

use sistership_report::numbers;

use crate::language::Language;

/// Value with significant digits.
pub(crate) fn format_significant(value: f64, digits: usize) -> String {
    with_decimal_mark(&numbers::format_significant(value, digits))
}

/// Value with at most these significant digits, without trailing zeros.
pub(crate) fn format_stated(value: f64, digits: usize) -> String {
    with_decimal_mark(&numbers::format_stated(value, digits))
}

/// Value with a fixed number of decimals.
pub(crate) fn format_fixed(value: f64, decimals: usize) -> String {
    with_decimal_mark(&numbers::format_fixed(value, decimals))
}

/// Value that may be unknown, which is a dash.
pub(crate) fn format_known(value: Option<f64>, format: impl Fn(f64) -> String) -> String {
    numbers::format_known(value, format)
}

/// Number as it was typed or stored.
pub(crate) fn format_plain(value: f64) -> String {
    with_decimal_mark(&value.to_string())
}

/// Replaces the decimal point of a number.
pub(crate) fn with_decimal_mark(number: &str) -> String {
    number.replace('.', &Language::current().decimal_mark().to_string())
}
