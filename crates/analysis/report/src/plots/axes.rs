//! Scales, ticks and grids.

use super::Shape;
use crate::numbers::format_fixed;

/// Linear scale from values to positions along an axis.
#[derive(Debug, Clone, Copy)]
pub struct AxisScale {
    /// Value at one end.
    pub low: f64,
    /// Value at the other end.
    pub high: f64,
    /// Length of the axis, in the plot's units.
    pub length: f64,
    /// True if larger values have smaller positions, as upwards on a screen.
    pub reversed: bool,
}

impl AxisScale {
    /// Position of a value along the axis.
    pub fn position_of(&self, value: f64) -> f64 {
        let share = (value - self.low) / (self.high - self.low);
        self.length * if self.reversed { 1.0 - share } else { share }
    }

    /// Values of about `about` ticks, with their labels.
    pub fn tick_labels(&self, about: usize) -> Vec<(f64, String)> {
        let step = nice_step((self.high - self.low) / about.max(1) as f64);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        // The tolerance keeps ticks at the very ends in spite of rounding.
        let (first, last) =
            ((self.low / step - 1e-9).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
        (first..=last)
            .map(|k| k as f64 * step)
            .map(|value| (value, format_fixed(value, decimals)))
            .collect()
    }
}

/// Smallest of 1, 2, 5 times a power of ten that is not below `least`.
pub fn nice_step(least: f64) -> f64 {
    // Largest power of ten that does not exceed the value.
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|of| of * power)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Range with a margin, never empty.
pub fn padded_range((low, high): (f64, f64), share: f64) -> (f64, f64) {
    // A constant signal gets a margin, too.
    let margin = share * (high - low).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
    (low - margin, high + margin)
}

/// Least and greatest of the finite values.
pub fn value_range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}

/// Displayed range: that of the measured values, extended for the others by at most its own size on
/// each side.
pub fn display_range(measured: Option<(f64, f64)>, others: Option<(f64, f64)>) -> (f64, f64) {
    match (measured, others) {
        (Some((low, high)), Some((from, to))) => {
            // A constant signal also gets a range, so that rounding errors do not fill the plot.
            let room = (high - low).max(0.02 * low.abs().max(high.abs())).max(1e-6);
            (low.min(from.max(low - room)), high.max(to.min(high + room)))
        }
        (Some(range), None) | (None, Some(range)) => range,
        (None, None) => (0.0, 1.0),
    }
}

/// Horizontal grid lines of a panel, with labels to its left.
pub fn grid_rows(at: (f64, f64), width: f64, scale: &AxisScale, about: usize) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for (value, label) in scale.tick_labels(about) {
        let y = at.1 + scale.position_of(value);
        // The zero line is drawn stronger.
        let class = if value == 0.0 { "zero" } else { "grid" };
        shapes.push(Shape::Line { from: (at.0, y), to: (at.0 + width, y), class });
        shapes.push(Shape::Text { at: (at.0 - 6.0, y + 3.6), text: label, class: "tick end" });
    }
    shapes
}

/// Vertical grid lines of a panel, with labels below it if requested.
pub fn grid_columns(
    at: (f64, f64),
    height: f64,
    scale: &AxisScale,
    about: usize,
    labelled: bool,
) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for (value, label) in scale.tick_labels(about) {
        let x = at.0 + scale.position_of(value);
        shapes.push(Shape::Line {
            from: (x, at.1),
            to: (x, at.1 + height),
            class: if value == 0.0 { "zero" } else { "grid" },
        });
        if labelled {
            shapes.push(Shape::Text {
                at: (x, at.1 + height + 14.0),
                text: label,
                class: "tick mid",
            });
        }
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = AxisScale { low: -0.31, high: 0.52, length: 100.0, reversed: false };
        let labels: Vec<String> =
            scale.tick_labels(4).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.0", "0.5"]);
        assert!((nice_step(0.21) - 0.5).abs() < 1e-12 && (nice_step(0.1) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_runaway_does_not_flatten_what_was_measured() {
        assert_eq!(display_range(Some((0.0, 10.0)), Some((-5.0, 1e6))), (-5.0, 20.0));
        assert_eq!(display_range(Some((5.0, 5.0)), Some((4.0, 6.0))), (4.9, 5.1));
    }
}
