//! The path over the ground, north up, equal scales.

use super::axes::{Scale, columns, extent, nice_step, rows, shown};
use super::decimate::path;
use super::lines::{self, PlottedLine};
use super::{Plot, Shape, WIDTH};
use crate::replayed::ReplayedTrial;

const LEFT: f64 = 52.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const LEAST: f64 = 150.0;
const MOST: f64 = 446.0;

/// North upwards and east to the right, metre by metre the same.
struct TrajectoryChart {
    east: Scale,
    north: Scale,
}

/// The trajectory of one trial.
pub(crate) fn trajectory(replayed: &ReplayedTrial<'_>) -> Plot {
    let lines = lines::positions(replayed);
    let chart = TrajectoryChart::of(&lines);
    let height = TOP + chart.north.length + BOTTOM;
    let mut shapes = chart.grid();
    let mut inside: Vec<Shape> = lines.iter().map(|line| chart.line(replayed, line)).collect();
    inside.extend(lines.iter().flat_map(|line| chart.marks(replayed, line)));
    shapes.push(Shape::Panel {
        at: (LEFT, TOP),
        size: (chart.east.length, chart.north.length),
        shapes: inside,
    });
    shapes.push(Shape::Rect {
        at: (LEFT, TOP),
        size: (chart.east.length, chart.north.length),
        class: "frame",
    });
    shapes.extend(lines.first().into_iter().flat_map(|line| chart.start(line)));
    Plot {
        width: WIDTH,
        height,
        label: format!("Trajectory of trial {}", replayed.trial.name),
        shapes,
    }
}

/// Seconds between the dots on a path.
pub(crate) fn mark_interval_s(duration_s: f64) -> f64 {
    nice_step((duration_s / 8.0).max(1e-3))
}

impl TrajectoryChart {
    fn of(lines: &[PlottedLine<(f64, f64)>]) -> Self {
        let range = |of: fn(&(f64, f64)) -> f64| {
            let own = |measured: bool| {
                let lines = lines.iter().filter(move |line| (line.class == "measured") == measured);
                extent(lines.flat_map(|line| line.values.iter().map(of)))
            };
            shown(own(true), own(false))
        };
        let (north, east) = (range(|point| point.0), range(|point| point.1));
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

    fn at(&self, (north, east): (f64, f64)) -> (f64, f64) {
        (self.east.at(east), self.north.at(north))
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

    fn line(&self, replayed: &ReplayedTrial<'_>, line: &PlottedLine<(f64, f64)>) -> Shape {
        let starts = lines::starts(replayed.trial);
        let points: Vec<(f64, f64)> = line.values.iter().map(|point| self.at(*point)).collect();
        let jumps = |from: usize, to: usize| {
            lines::has_gap(replayed.trial, &starts, line.samples[from], line.samples[to])
        };
        Shape::Path { d: path(&points, jumps), class: line.class }
    }

    /// Dots at the same instants on every path.
    fn marks(&self, replayed: &ReplayedTrial<'_>, line: &PlottedLine<(f64, f64)>) -> Vec<Shape> {
        let times = &replayed.trial.t_s;
        let interval = mark_interval_s(replayed.trial.duration_s());
        let number =
            |index: usize| ((times[line.samples[index]] - times[0]) / interval + 1e-9).floor();
        let crossed = |index: &usize| number(*index) > number(*index - 1);
        let dot = |index: usize| Shape::Dot {
            at: self.at(line.values[index]),
            radius: 2.6,
            class: dot_class(line.class),
        };
        (1..line.values.len()).filter(crossed).map(dot).collect()
    }

    fn start(&self, line: &PlottedLine<(f64, f64)>) -> Vec<Shape> {
        let Some(first) = line.values.first() else { return Vec::new() };
        let (x, y) = self.at(*first);
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

fn dot_class(line: &str) -> &'static str {
    match line {
        "source" => "dot source",
        "refined" => "dot refined",
        _ => "dot measured",
    }
}
