//! Small plots, three of them side by side: two scales, a frame, and content.

use super::axes::{Scale, columns, extent, padded, rows};
use super::{Plot, Shape};

const WIDTH: f64 = 350.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 38.0;

/// Small plot without its content.
pub(super) struct SmallPlot {
    across: Scale,
    up: Scale,
}

impl SmallPlot {
    /// Creates a plot over the range of some points, with the given height.
    pub fn over<'a>(points: impl Iterator<Item = &'a (f64, f64)> + Clone, height: f64) -> Self {
        let range = |of: fn(&(f64, f64)) -> f64| {
            padded(extent(points.clone().map(of)).unwrap_or((0.0, 1.0)), 0.05)
        };
        let (x, y) = (range(|point| point.0), range(|point| point.1));
        Self {
            across: Scale { low: x.0, high: x.1, length: WIDTH - LEFT - RIGHT, reversed: false },
            up: Scale { low: y.0, high: y.1, length: height, reversed: true },
        }
    }

    /// Position of a point in the frame.
    pub fn at(&self, point: &(f64, f64)) -> (f64, f64) {
        (self.across.at(point.0), self.up.at(point.1))
    }

    /// Returns the plot with its content, a title above and a title below the axis.
    pub fn with(&self, content: Vec<Shape>, title: String, below: String, label: String) -> Plot {
        let (size, corner) = ((self.across.length, self.up.length), (LEFT, TOP));
        let mut shapes = vec![Shape::Text { at: (LEFT, TOP - 8.0), text: title, class: "title" }];
        shapes.extend(rows(corner, self.across.length, &self.up, 5));
        shapes.extend(columns(corner, self.up.length, &self.across, 5, true));
        shapes.push(Shape::Panel { at: corner, size, shapes: content });
        shapes.push(Shape::Rect { at: corner, size, class: "frame" });
        let under = (LEFT + 0.5 * self.across.length, TOP + self.up.length + 32.0);
        shapes.push(Shape::Text { at: under, text: below, class: "title mid" });
        Plot { width: WIDTH, height: TOP + self.up.length + BOTTOM, label, shapes }
    }
}
