//! Chart of the ground: north up, east to the right, on equal scales.

use super::axes::{AxisScale, grid_columns, grid_rows, nice_step};
use super::{GROUND, HullOutline, PanelAxes, Shape, WIDTH};

const LEFT: f64 = 52.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const LEAST: f64 = 150.0;
const MOST: f64 = 446.0;
/// Outlines shorter than this are not drawn, in the plot's units.
const LEAST_OUTLINE: f64 = 5.0;

/// Chart with north upwards and east to the right.
#[derive(Debug)]
pub struct GroundChart {
    east: AxisScale,
    north: AxisScale,
}

impl GroundChart {
    /// Creates a chart of positions in these ranges, m, with a margin, and with room for a ship at
    /// each of them.
    pub fn from_ranges(north: (f64, f64), east: (f64, f64), hull: Option<HullOutline>) -> Self {
        // Half a ship length of room around every position.
        let half_m = hull.map_or(0.0, |hull| 0.5 * hull.lpp_m);
        let [north, east] = [north, east].map(|(low, high)| (low - half_m, high + half_m));
        let width = WIDTH - LEFT - RIGHT;
        let span = |range: (f64, f64)| (range.1 - range.0).max(1e-6) * 1.1;
        // One scale for both directions, m per unit: the tighter of width and largest height.
        let metres = (span(east) / width).max(span(north) / MOST);
        let height = (span(north) / metres).clamp(LEAST, MOST);
        let around = |range: (f64, f64), length: f64, reversed: bool| {
            let (middle, half) = (0.5 * (range.0 + range.1), 0.5 * length * metres);
            AxisScale { low: middle - half, high: middle + half, length, reversed }
        };
        Self { east: around(east, width, false), north: around(north, height, true) }
    }

    /// Height of a plot that holds only this chart.
    pub fn plot_height(&self) -> f64 {
        TOP + self.north.length + BOTTOM
    }

    /// Position of a point `(north, east)` within the panel.
    pub fn position_of(&self, (north, east): (f64, f64)) -> (f64, f64) {
        (self.east.position_of(east), self.north.position_of(north))
    }

    /// Shapes of the chart: grid with labels, content clipped at the edges, and frame.
    pub fn draw_chart(&self, inside: Vec<Shape>) -> Vec<Shape> {
        let (at, size) = ((LEFT, TOP), (self.east.length, self.north.length));
        let mut shapes = self.draw_grid();
        let axes = PanelAxes {
            quantity: GROUND.to_owned(),
            title: "position".to_owned(),
            unit: "m",
            across: self.east,
            up: self.north,
        };
        shapes.push(Shape::Panel { at, size, shapes: inside, axes: Some(axes) });
        shapes.push(Shape::Rect { at, size, class: "frame" });
        shapes
    }

    /// Outline of a ship at a position and heading; `None` if it would be too small to see.
    pub fn ship_outline(
        &self,
        hull: HullOutline,
        place: (f64, f64),
        psi_rad: f64,
        class: &'static str,
    ) -> Option<Shape> {
        let metres = (self.east.high - self.east.low) / self.east.length;
        if hull.lpp_m / metres < LEAST_OUTLINE {
            return None;
        }
        let corners: Vec<String> = hull
            .corners_at(place, psi_rad)
            .into_iter()
            .map(|corner| self.position_of(corner))
            .map(|(x, y)| format!("{x:.1} {y:.1}"))
            .collect();
        Some(Shape::Path { d: format!("M{}Z", corners.join("L")), class })
    }

    fn draw_grid(&self) -> Vec<Shape> {
        let metres = (self.east.high - self.east.low) / self.east.length;
        let about = |length: f64| (length * metres / nice_step(50.0 * metres)).ceil() as usize;
        let mut shapes =
            grid_rows((LEFT, TOP), self.east.length, &self.north, about(self.north.length));
        shapes.extend(grid_columns(
            (LEFT, TOP),
            self.north.length,
            &self.east,
            about(self.east.length),
            true,
        ));
        let bottom = TOP + self.north.length + BOTTOM - 4.0;
        shapes.push(Shape::Text {
            at: (LEFT, TOP - 9.0),
            text: "x north [m] ↑".into(),
            class: "title",
        });
        let east = (LEFT + self.east.length / 2.0, bottom);
        shapes.push(Shape::Text { at: east, text: "y east [m] →".into(), class: "title mid" });
        shapes
    }

    /// Mark and label of the start of a track.
    pub fn start_mark(&self, place: (f64, f64)) -> Vec<Shape> {
        let (x, y) = self.position_of(place);
        let (x, y) = (LEFT + x, TOP + y);
        // Close to the right edge the label is placed to the left of the mark.
        let (side, class) =
            if x > LEFT + 0.75 * self.east.length { (-9.0, "start end") } else { (9.0, "start") };
        let text = Shape::Text {
            at: (x + side, y + 13.0_f64.min(TOP + self.north.length - y - 3.0)),
            text: "start".into(),
            class,
        };
        vec![Shape::Dot { at: (x, y), radius: 5.0, class: "ring" }, text]
    }
}
