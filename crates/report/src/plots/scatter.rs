//! The residual of an acceleration against the variable that explains most of it, before and after,
//! all trials together.

use std::collections::BTreeMap;

use sistership_diagnose::ResidualSeries;

use super::axes::{Scale, columns, extent, padded, rows};
use super::decimate::kept;
use super::{Plot, Shape};
use crate::words::{acceleration, recorded};

/// Narrower than other plots: three stand side by side.
const WIDTH: f64 = 350.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 24.0;
const HEIGHT: f64 = 190.0;
const BOTTOM: f64 = 38.0;

/// One plot for each acceleration and variable.
pub(crate) fn scatters(residuals: &[ResidualSeries]) -> Vec<Plot> {
    let mut groups: BTreeMap<(usize, &str, &str), Vec<&ResidualSeries>> = BTreeMap::new();
    for series in residuals
        .iter()
        .filter(|series| series.variable.len() == series.t_s.len() && !series.t_s.is_empty())
    {
        let rank =
            ["u", "v", "r", "p"].iter().position(|known| *known == series.channel).unwrap_or(4);
        groups.entry((rank, &series.channel, &series.against)).or_default().push(series);
    }
    groups
        .into_iter()
        .map(|((_, channel, against), group)| scatter(channel, against, &group))
        .collect()
}

fn scatter(channel: &str, against: &str, group: &[&ResidualSeries]) -> Plot {
    let ((name, unit, of_variable), (residual_unit, factor)) =
        (recorded(against), acceleration(channel));
    let points = |of: fn(&ResidualSeries) -> &[f64]| -> Vec<(f64, f64)> {
        let pairs = group.iter().flat_map(|series| series.variable.iter().zip(of(series)));
        pairs.map(|(x, y)| (of_variable(*x), y * factor)).collect()
    };
    let (before, after) = (points(|series| &series.before), points(|series| &series.after));
    let range = |of: fn(&(f64, f64)) -> f64| {
        padded(extent(before.iter().chain(&after).map(of)).unwrap_or((0.0, 1.0)), 0.05)
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let across = Scale { low: x.0, high: x.1, length: WIDTH - LEFT - RIGHT, reversed: false };
    let up = Scale { low: y.0, high: y.1, length: HEIGHT, reversed: true };
    let title = format!("residual of d{channel}/dt [{residual_unit}]");
    let mut shapes = vec![Shape::Text { at: (LEFT, TOP - 8.0), text: title, class: "title" }];
    shapes.extend(rows((LEFT, TOP), across.length, &up, 5));
    shapes.extend(columns((LEFT, TOP), HEIGHT, &across, 5, true));
    let clouds = [(before, "cloud source"), (after, "cloud refined")]
        .map(|(points, class)| cloud(&points, &across, &up, class));
    shapes.push(Shape::Panel {
        at: (LEFT, TOP),
        size: (across.length, HEIGHT),
        shapes: clouds.into(),
    });
    shapes.push(Shape::Rect { at: (LEFT, TOP), size: (across.length, HEIGHT), class: "frame" });
    let below = (LEFT + across.length / 2.0, TOP + HEIGHT + 32.0);
    shapes.push(Shape::Text { at: below, text: format!("{name} [{unit}]"), class: "title mid" });
    Plot {
        width: WIDTH,
        height: TOP + HEIGHT + BOTTOM,
        label: format!("Residual of d{channel}/dt against {name}"),
        shapes,
    }
}

/// Points as strokes without length: far smaller than as many circles.
fn cloud(points: &[(f64, f64)], across: &Scale, up: &Scale, class: &'static str) -> Shape {
    let dot = |index: usize| {
        format!("M{:.1} {:.1}h0", across.at(points[index].0), up.at(points[index].1))
    };
    Shape::Path { d: kept(points.len()).into_iter().map(dot).collect(), class }
}
