//! Change of each coefficient of an axis, in standard deviations of the prior.

use super::coefficients::{AxisChanges, CoefficientEntry, CoefficientReport};
use crate::numbers::format_signed;
use crate::plots::axes::{AxisScale, grid_columns};
use crate::plots::{Shape, SvgPlot};
use crate::words;

/// Width, smaller than that of other plots: three are side by side.
const WIDTH: f64 = 350.0;
const LEFT: f64 = 142.0;
const RIGHT: f64 = 54.0;
const TOP: f64 = 10.0;
const ROW: f64 = 18.0;
const BOTTOM: f64 = 38.0;

/// Returns one plot for each axis, all on the same scale.
pub(crate) fn shift_plots(coefficients: &CoefficientReport<'_>) -> Vec<(&'static str, SvgPlot)> {
    let most = coefficients
        .all_entries()
        .map(|c| c.change.moved_sd.abs())
        .filter(|sd| sd.is_finite())
        .fold(1.1, f64::max);
    let scale = AxisScale {
        low: -1.06 * most,
        high: 1.06 * most,
        length: WIDTH - LEFT - RIGHT,
        reversed: false,
    };
    coefficients
        .axes
        .iter()
        .map(|axis| (words::axis_words(axis.axis), axis_plot(axis, &scale)))
        .collect()
}

fn axis_plot(axis: &AxisChanges<'_>, scale: &AxisScale) -> SvgPlot {
    let inner = ROW * axis.coefficients.len() as f64;
    // The shaded area is one standard deviation of the prior to either side.
    let one = (scale.position_of(-1.0), scale.position_of(1.0));
    let mut shapes =
        vec![Shape::Rect { at: (LEFT + one.0, TOP), size: (one.1 - one.0, inner), class: "prior" }];
    shapes.extend(grid_columns((LEFT, TOP), inner, scale, 5, true));
    for (index, change) in axis.coefficients.iter().enumerate() {
        shapes.extend(coefficient_shapes(change, TOP + ROW * (index as f64 + 0.5), scale));
    }
    let title = (LEFT + scale.length / 2.0, TOP + inner + 32.0);
    shapes.push(Shape::Text {
        at: title,
        text: "moved [prior standard deviations]".into(),
        class: "title mid",
    });
    let label = format!("How far the coefficients of {} moved", words::axis_words(axis.axis));
    SvgPlot { width: WIDTH, height: TOP + inner + BOTTOM, label, shapes }
}

fn coefficient_shapes(change: &CoefficientEntry<'_>, y: f64, scale: &AxisScale) -> Vec<Shape> {
    let name = match change.collinear_group {
        Some(group) => format!("{} ◇{group}", change.change.name),
        None => change.change.name.clone(),
    };
    let moved = if change.change.moved_sd.is_finite() { change.change.moved_sd } else { 0.0 };
    let (zero, end) = (LEFT + scale.position_of(0.0), LEFT + scale.position_of(moved));
    vec![
        Shape::Text { at: (LEFT - 8.0, y + 3.8), text: name, class: "name end" },
        Shape::Line { from: (zero, y), to: (end, y), class: "stem" },
        Shape::Dot { at: (end, y), radius: 4.0, class: "dot refined" },
        Shape::Text {
            at: (WIDTH - 4.0, y + 3.8),
            text: format_signed(moved, 2),
            class: "tick end",
        },
    ]
}
