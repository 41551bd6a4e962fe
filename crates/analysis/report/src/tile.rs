//! Headline figures: an error before and after, with bars.

use crate::error_row::ErrorRow;
use crate::numbers::{format_fixed, format_significant};

/// Headline figure of one channel.
pub(crate) struct ErrorTile {
    pub name: &'static str,
    pub change: String,
    pub class: &'static str,
    pub before: String,
    pub after: String,
    /// Lengths of the two bars, per cent of the longer one.
    pub bars: (String, String),
}

impl ErrorTile {
    /// Creates the figure of one channel.
    pub fn from_row(row: &ErrorRow) -> Self {
        let unit = row.quantity.unit;
        let text = |value: Option<f64>| {
            value.map_or_else(
                || "–".into(),
                |value| format!("{} {unit}", format_significant(value, 3)),
            )
        };
        // Never zero, as it is a divisor.
        let most = row.source.unwrap_or(0.0).max(row.refined.unwrap_or(0.0)).max(1e-300);
        let bar = |value: Option<f64>| format_fixed(100.0 * value.unwrap_or(0.0) / most, 1);
        let class = match row.error_change().0 {
            "fell" => "good",
            "rose" => "bad",
            _ => "open",
        };
        Self {
            name: row.quantity.name,
            change: row.change_text(),
            class,
            before: text(row.source),
            after: text(row.refined),
            bars: (bar(row.source), bar(row.refined)),
        }
    }
}
