//! Root mean squared errors of one channel before and after, and the words for their change.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::numbers::format_fixed;
use crate::words::DisplayChannel;

/// Relative changes below this are reported as unchanged.
const SAME: f64 = 0.005;

/// Root mean squared error of one channel, in its displayed unit.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct ErrorRow {
    #[serde(flatten)]
    pub quantity: DisplayChannel,
    pub source: Option<f64>,
    pub refined: Option<f64>,
    /// Source error divided by refined error: above one if the error fell.
    pub factor: Option<f64>,
}

impl ErrorRow {
    /// Error of a channel in both models.
    pub fn from_errors(
        quantity: DisplayChannel,
        source: &BTreeMap<String, f64>,
        refined: &BTreeMap<String, f64>,
    ) -> Self {
        let shown =
            |errors| channel_error(errors, quantity.channel).map(|value| value * quantity.factor);
        let (source, refined) = (shown(source), shown(refined));
        // A factor needs two positive errors.
        let factor = source.zip(refined).filter(|(s, r)| *s > 0.0 && *r > 0.0).map(|(s, r)| s / r);
        Self { quantity, source, refined, factor }
    }

    /// Direction of the change, `fell`, `rose` or `unchanged`, and its factor.
    pub fn error_change(&self) -> (&'static str, f64) {
        match self.factor {
            None => ("unknown", 1.0),
            Some(factor) if (factor - 1.0).abs() < SAME => ("unchanged", 1.0),
            Some(factor) if factor > 1.0 => ("fell", factor),
            Some(factor) => ("rose", 1.0 / factor),
        }
    }

    /// Change in words: `4.2 times smaller`.
    pub fn change_text(&self) -> String {
        match self.error_change() {
            ("fell", factor) => format!("{} times smaller", format_factor(factor)),
            ("rose", factor) => format!("{} times larger", format_factor(factor)),
            (word, _) => word.into(),
        }
    }
}

/// Factor with two significant digits, never rounded to 1.
pub(crate) fn format_factor(factor: f64) -> String {
    let decimals = if factor < 1.95 { 2 } else { usize::from(factor < 9.95) };
    format_fixed(factor, decimals)
}

/// Error of a channel; that of the horizontal position is combined from north and east.
fn channel_error(errors: &BTreeMap<String, f64>, channel: &str) -> Option<f64> {
    if channel == "position" {
        return Some(channel_error(errors, "x")?.hypot(channel_error(errors, "y")?));
    }
    // Errors that are not finite, or near overflow, are unknown.
    errors.get(channel).copied().filter(|value| value.is_finite() && *value < 1e300)
}
