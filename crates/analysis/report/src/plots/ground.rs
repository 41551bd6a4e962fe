//! A chart of the ground: north up, east to the right, metre by metre the same.

use super::axes::{Scale, columns, nice_step, rows};
use super::{Hull, Shape, WIDTH};

const LEFT: f64 = 52.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const LEAST: f64 = 150.0;
const MOST: f64 = 446.0;
/// An outline shorter than this says nothing, in the plot's units.
const LEAST_OUTLINE: f64 = 5.0;

/// North upwards and east to the right.
#[derive(Debug)]
pub struct GroundChart {
    east: Scale,
    north: Scale,
}

impl GroundChart {
    /// That holds places in these ranges, m, with a margin, and a ship at each of them.
    pub fn of(north: (f64, f64), east: (f64, f64), hull: Option<Hull>) -> Self {
        let half_m = hull.map_or(0.0, |hull| 0.5 * hull.lpp_m);
        let [north, east] = [north, east].map(|(low, high)| (low - half_m, high + half_m));
        let width = WIDTH - LEFT - RIGHT;
        let span = |range: (f64, f64)| (range.1 - range.0).max(1e-6) * 1.1;
        let metres = (span(east) / width).max(span(north) / MOST);
        let height = (span(north) / metres).clamp(LEAST, MOST);
        let around = |range: (f64, f64), length: f64, reversed: bool| {
            let (middle, half) = (0.5 * (range.0 + range.1), 0.5 * length * metres);
            Scale { low: middle - half, high: middle + half, length, reversed }
        };
        Self { east: around(east, width, false), north: around(north, height, true) }
    }

    /// The height of a plot that it fills.
    pub fn height(&self) -> f64 {
        TOP + self.north.length + BOTTOM
    }

    /// Where a point `(north, east)` stands within the panel.
    pub fn at(&self, (north, east): (f64, f64)) -> (f64, f64) {
        (self.east.at(east), self.north.at(north))
    }

    /// The grid with its labels, what is inside, cut off at the edges, and the frame.
    pub fn drawn(&self, inside: Vec<Shape>) -> Vec<Shape> {
        let (at, size) = ((LEFT, TOP), (self.east.length, self.north.length));
        let mut shapes = self.grid();
        shapes.push(Shape::Panel { at, size, shapes: inside });
        shapes.push(Shape::Rect { at, size, class: "frame" });
        shapes
    }

    /// The outline of a ship at a place and heading; none where it would be too small to see.
    pub fn outline(
        &self,
        hull: Hull,
        place: (f64, f64),
        psi_rad: f64,
        class: &'static str,
    ) -> Option<Shape> {
        let metres = (self.east.high - self.east.low) / self.east.length;
        if hull.lpp_m / metres < LEAST_OUTLINE {
            return None;
        }
        let corners: Vec<String> = hull
            .outline(place, psi_rad)
            .into_iter()
            .map(|corner| self.at(corner))
            .map(|(x, y)| format!("{x:.1} {y:.1}"))
            .collect();
        Some(Shape::Path { d: format!("M{}Z", corners.join("L")), class })
    }

    fn grid(&self) -> Vec<Shape> {
        let metres = (self.east.high - self.east.low) / self.east.length;
        let about = |length: f64| (length * metres / nice_step(50.0 * metres)).ceil() as usize;
        let mut shapes = rows((LEFT, TOP), self.east.length, &self.north, about(self.north.length));
        shapes.extend(columns(
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

    /// A ring and a word where a track starts.
    pub fn start(&self, place: (f64, f64)) -> Vec<Shape> {
        let (x, y) = self.at(place);
        let (x, y) = (LEFT + x, TOP + y);
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
