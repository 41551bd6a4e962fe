//! Plots as inline SVG, and the shapes that several pages draw.

use askama::Template;
use sistership_report::plots::{Shape, SvgPlot};

use crate::error::Result;
use crate::language::say;
use crate::numbers::with_decimal_mark;

/// Renders a plot as SVG.
pub(crate) fn render_svg(plot: &SvgPlot) -> Result<String> {
    Ok(plot.render()?)
}

/// Returns a plot with the decimal mark and the common words of the language.
pub(crate) fn localize_plot(plot: SvgPlot) -> SvgPlot {
    let shapes = plot.shapes.into_iter().map(localize_shape).collect();
    SvgPlot { shapes, ..plot }
}

fn localize_shape(shape: Shape) -> Shape {
    match shape {
        Shape::Text { at, text, class } => Shape::Text { at, text: localize_text(text), class },
        other => other,
    }
}

/// Translates a text of the plots that reports share; others are of a page and in its language.
fn localize_text(text: String) -> String {
    match text.as_str() {
        "start" => say("plot-start").into(),
        "x north [m] ↑" => say("plot-north").into(),
        "y east [m] →" => say("plot-east").into(),
        number if number.parse::<f64>().is_ok() || number.starts_with('−') => {
            with_decimal_mark(number)
        }
        _ => text,
    }
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
