//! Plots as inline SVG, and the shapes that several pages draw.

use askama::Template;
use sistership_report::plots::{Shape, SvgPlot};

use crate::error::Result;

/// Renders a plot as SVG.
pub(crate) fn render_svg(plot: &SvgPlot) -> Result<String> {
    Ok(plot.render()?)
}

/// Returns a straight line.
pub(crate) fn line_shape(from: (f64, f64), to: (f64, f64), class: &'static str) -> Shape {
    Shape::Line { from, to, class }
}

/// Returns a text.
pub(crate) fn text_shape(at: (f64, f64), text: impl Into<String>, class: &'static str) -> Shape {
    Shape::Text { at, text: text.into(), class }
}

/// Returns a closed polygon.
pub(crate) fn polygon_shape(corners: &[(f64, f64)], class: &'static str) -> Shape {
    let corners: Vec<String> = corners.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    Shape::Path { d: format!("M{}Z", corners.join("L")), class }
}
