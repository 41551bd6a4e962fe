//! Plots as inline SVG: a few shapes, axes with nice ticks, and what is drawn on them.

pub mod axes;
mod decimate;
mod dependence;
mod ground;
mod hull;
mod lines;
mod residual;
mod scatter;
mod series;
mod small;
mod trajectory;

use askama::Template;

pub use decimate::{kept, path};
pub(crate) use dependence::dependences;
pub use ground::GroundChart;
pub use hull::Hull;
pub(crate) use residual::residual;
pub(crate) use scatter::scatters;
pub(crate) use series::series;
pub use trajectory::mark_interval_s;
pub(crate) use trajectory::trajectory;

/// Width of every plot in its own units, near that of a phone's screen, so that text stays legible
/// there.
pub const WIDTH: f64 = 420.0;

/// A plot.
#[derive(Debug, Template)]
#[template(path = "report_plot.html")]
pub struct Plot {
    /// Its width in its own units.
    pub width: f64,
    /// Its height.
    pub height: f64,
    /// What it shows, for those who cannot see it.
    pub label: String,
    /// What is drawn, in this order.
    pub shapes: Vec<Shape>,
}

/// What plots are made of. `class` is a style of the page.
#[derive(Debug)]
#[allow(missing_docs, reason = "from, to, at, size say what they are")]
pub enum Shape {
    /// A straight line.
    Line { from: (f64, f64), to: (f64, f64), class: &'static str },
    /// A line through many points, as path data.
    Path { d: String, class: &'static str },
    /// A rectangle.
    Rect { at: (f64, f64), size: (f64, f64), class: &'static str },
    /// A dot.
    Dot { at: (f64, f64), radius: f64, class: &'static str },
    /// Text; `class` also anchors it.
    Text { at: (f64, f64), text: String, class: &'static str },
    /// Shapes in the coordinates of a panel, cut off at its edges.
    Panel { at: (f64, f64), size: (f64, f64), shapes: Vec<Shape> },
}
