//! Small plots, three of them side by side: two scales, a frame, and content.

use super::axes::{AxisScale, grid_columns, grid_rows, padded_range, value_range};
use super::{Shape, SvgPlot};

const WIDTH: f64 = 350.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 38.0;

/// Small plot without its content.
pub(super) struct SmallPlot {
    across: AxisScale,
    up: AxisScale,
}

impl SmallPlot {
    /// Creates a plot over the range of some points, with the given height.
    pub fn from_points<'a>(
        points: impl Iterator<Item = &'a (f64, f64)> + Clone,
        height: f64,
    ) -> Self {
        let range = |of: fn(&(f64, f64)) -> f64| {
            padded_range(value_range(points.clone().map(of)).unwrap_or((0.0, 1.0)), 0.05)
        };
        let (x, y) = (range(|point| point.0), range(|point| point.1));
        Self {
            across: AxisScale {
                low: x.0,
                high: x.1,
                length: WIDTH - LEFT - RIGHT,
                reversed: false,
            },
            up: AxisScale { low: y.0, high: y.1, length: height, reversed: true },
        }
    }

    /// Position of a point in the frame.
    pub fn position_of(&self, point: &(f64, f64)) -> (f64, f64) {
        (self.across.position_of(point.0), self.up.position_of(point.1))
    }

    /// Returns the plot with its content, a title above and a title below the axis.
    pub fn with_content(
        &self,
        content: Vec<Shape>,
        title: String,
        below: String,
        label: String,
    ) -> SvgPlot {
        let (size, corner) = ((self.across.length, self.up.length), (LEFT, TOP));
        let mut shapes = vec![Shape::Text { at: (LEFT, TOP - 8.0), text: title, class: "title" }];
        shapes.extend(grid_rows(corner, self.across.length, &self.up, 5));
        shapes.extend(grid_columns(corner, self.up.length, &self.across, 5, true));
        shapes.push(Shape::Panel { at: corner, size, shapes: content, axes: None });
        shapes.push(Shape::Rect { at: corner, size, class: "frame" });
        let under = (LEFT + 0.5 * self.across.length, TOP + self.up.length + 32.0);
        shapes.push(Shape::Text { at: under, text: below, class: "title mid" });
        SvgPlot { width: WIDTH, height: TOP + self.up.length + BOTTOM, label, shapes }
    }
}
