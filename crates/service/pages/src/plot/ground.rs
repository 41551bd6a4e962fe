//! Tracks over the ground, with the outline of the ship at the same instants on each.

use sistership_report::plots::axes::extent;
use sistership_report::plots::{GroundChart, Hull, Plot, Shape, WIDTH, mark_interval_s, path};

use super::track::Track;
use sistership_model::trial::Channel;

/// Returns the tracks; `None` if no track has positions. `label` describes the plot.
pub(crate) fn ground(tracks: &[Track], hull: Option<Hull>, label: &str) -> Option<Plot> {
    let placed: Vec<(&Track, Vec<(f64, f64)>)> =
        tracks.iter().filter_map(|track| Some((track, track.places()?))).collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        extent(placed.iter().flat_map(|(_, places)| places.iter().map(of)))
    };
    let chart = GroundChart::of(range(|place| place.0)?, range(|place| place.1)?, hull);
    let mut inside: Vec<Shape> =
        placed.iter().map(|(track, places)| curve(&chart, track, places)).collect();
    // The same interval for all tracks, so that outlines of the same number belong to the same
    // instant.
    let interval = mark_interval_s(0.5 * duration_s(&placed));
    inside.extend(
        placed.iter().flat_map(|(track, places)| marks(&chart, track, places, hull, interval)),
    );
    let mut shapes = chart.drawn(inside);
    let first = placed.first().and_then(|(_, places)| places.first());
    shapes.extend(first.into_iter().flat_map(|place| chart.start(*place)));
    Some(Plot { width: WIDTH, height: chart.height(), label: label.to_owned(), shapes })
}

fn duration_s(placed: &[(&Track, Vec<(f64, f64)>)]) -> f64 {
    let of = |track: &Track| Some(track.t_s.last()? - track.t_s.first()?);
    placed.iter().filter_map(|(track, _)| of(track)).fold(0.0, f64::max)
}

fn curve(chart: &GroundChart, track: &Track, places: &[(f64, f64)]) -> Shape {
    let points: Vec<(f64, f64)> = places.iter().map(|place| chart.at(*place)).collect();
    Shape::Path { d: path(&points, |from, to| track.jumps(from, to)), class: track.style.line }
}

/// Returns outlines where heading and hull are known, otherwise dots.
fn marks(
    chart: &GroundChart,
    track: &Track,
    places: &[(f64, f64)],
    hull: Option<Hull>,
    interval: f64,
) -> Vec<Shape> {
    let heading = track.channels.get(&Channel::Psi);
    let number = |sample: usize| ((track.t_s[sample] - track.t_s[0]) / interval + 1e-9).floor();
    // The small offset keeps a sample at a whole multiple of the interval from falling short of it
    // by rounding.
    let due = |sample: &usize| *sample == 0 || number(*sample) > number(*sample - 1);
    let mark = |sample: usize| {
        let outline =
            || chart.outline(hull?, places[sample], *heading?.get(sample)?, track.style.hull);
        let (at, class) = (chart.at(places[sample]), track.style.dot);
        outline().unwrap_or(Shape::Dot { at, radius: 1.4, class })
    };
    (0..places.len()).filter(due).map(mark).collect()
}
