//! Plots as inline SVG: basic shapes, axes with round tick values, and the plots of the reports.

pub mod axes;
mod decimate;
mod dependence;
mod ground;
mod hull;
mod lines;
mod live;
mod replay_chart;
mod residual;
mod scatter;
mod series;
mod small;
mod trajectory;

use askama::Template;

pub use decimate::{drawn_indices, path_data};
pub(crate) use dependence::dependence_plots;
pub use ground::GroundChart;
pub use hull::HullOutline;
pub use live::{ChartLine, GROUND, LiveChart, PanelAxes};
pub(crate) use replay_chart::replay_chart;
pub(crate) use residual::residual_chart;
pub(crate) use scatter::scatter_plots;
pub use trajectory::mark_interval_s;

/// Width of every plot in its own units, close to that of a phone's screen, so that text stays
/// legible there.
pub const WIDTH: f64 = 420.0;

/// Plot as shapes in a coordinate system.
#[derive(Debug, Template)]
#[template(path = "report_plot.html")]
pub struct SvgPlot {
    /// Width in its own units.
    pub width: f64,
    /// Height in the same units.
    pub height: f64,
    /// Text alternative for screen readers.
    pub label: String,
    /// Shapes in drawing order.
    pub shapes: Vec<Shape>,
}

/// Shape of a plot. `class` is a style class of the page.
#[derive(Debug)]
#[allow(missing_docs, reason = "from, to, at, size say what they are")]
pub enum Shape {
    /// Straight line.
    Line { from: (f64, f64), to: (f64, f64), class: &'static str },
    /// Line through many points, as path data.
    Path { d: String, class: &'static str },
    /// Rectangle.
    Rect { at: (f64, f64), size: (f64, f64), class: &'static str },
    /// Dot.
    Dot { at: (f64, f64), radius: f64, class: &'static str },
    /// Text; `class` also anchors it.
    Text { at: (f64, f64), text: String, class: &'static str },
    /// Shapes in the coordinates of a panel, clipped at its edges.
    Panel { at: (f64, f64), size: (f64, f64), shapes: Vec<Shape>, axes: Option<PanelAxes> },
}
