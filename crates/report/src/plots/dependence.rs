//! How what is left of an acceleration depends on a variable: the mean over the samples where that
//! is held.

use sistership_diagnose::{RemainderDependence, VariableDependence};

use super::axes::{Scale, columns, extent, padded, rows};
use super::decimate::path;
use super::{Plot, Shape};
use crate::words::{acceleration, recorded};

/// As wide as the other plots of which three stand side by side.
const WIDTH: f64 = 350.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 24.0;
const HEIGHT: f64 = 150.0;
const BOTTOM: f64 = 38.0;

/// One plot for each acceleration and variable.
pub(crate) fn dependences(all: &[RemainderDependence]) -> Vec<Plot> {
    let of = |one: &RemainderDependence| -> Vec<Plot> {
        one.variables.iter().map(|variable| plot(&one.channel, variable)).collect()
    };
    all.iter().flat_map(of).collect()
}

fn plot(channel: &str, variable: &VariableDependence) -> Plot {
    let (name, unit, shown) = recorded(&variable.variable);
    let (of_rest, factor) = acceleration(channel);
    let mut points: Vec<(f64, f64)> =
        variable.at.iter().zip(&variable.remainder).map(|(x, y)| (shown(*x), y * factor)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let range = |of: fn(&(f64, f64)) -> f64| {
        padded(extent(points.iter().map(of)).unwrap_or((0.0, 1.0)), 0.08)
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let across = Scale { low: x.0, high: x.1, length: WIDTH - LEFT - RIGHT, reversed: false };
    let up = Scale { low: y.0, high: y.1, length: HEIGHT, reversed: true };
    let title = format!("left of d{channel}/dt [{of_rest}]");
    let mut shapes = vec![Shape::Text { at: (LEFT, TOP - 8.0), text: title, class: "title" }];
    shapes.extend(rows((LEFT, TOP), across.length, &up, 4));
    shapes.extend(columns((LEFT, TOP), HEIGHT, &across, 5, true));
    let places: Vec<(f64, f64)> = points.iter().map(|(x, y)| (across.at(*x), up.at(*y))).collect();
    let line = Shape::Path { d: path(&places, |_, _| false), class: "refined" };
    let size = (across.length, HEIGHT);
    shapes.push(Shape::Panel { at: (LEFT, TOP), size, shapes: vec![line] });
    shapes.push(Shape::Rect { at: (LEFT, TOP), size, class: "frame" });
    let below = (LEFT + across.length / 2.0, TOP + HEIGHT + 32.0);
    shapes.push(Shape::Text { at: below, text: format!("{name} [{unit}]"), class: "title mid" });
    Plot {
        width: WIDTH,
        height: TOP + HEIGHT + BOTTOM,
        label: format!("What is left of d{channel}/dt by {name}"),
        shapes,
    }
}
