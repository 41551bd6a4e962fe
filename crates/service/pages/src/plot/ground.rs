//! Tracks over the ground, with the outline of the ship at the same instants on each.

use sistership_report::plots::axes::value_range;
use sistership_report::plots::{
    GroundChart, HullOutline, Shape, SvgPlot, WIDTH, mark_interval_s, path_data,
};

use sistership_model::trial::Channel;

use super::track::PlotTrack;
use crate::picture::localize_plot;

/// Returns the tracks; `None` if no track has positions. `label` describes the plot.
pub(crate) fn plot_ground(
    tracks: &[PlotTrack],
    hull: Option<HullOutline>,
    label: &str,
) -> Option<SvgPlot> {
    let placed: Vec<(&PlotTrack, Vec<(f64, f64)>)> =
        tracks.iter().filter_map(|track| Some((track, track.positions()?))).collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        value_range(placed.iter().flat_map(|(_, places)| places.iter().map(of)))
    };
    let chart = GroundChart::from_ranges(range(|place| place.0)?, range(|place| place.1)?, hull);
    let mut inside: Vec<Shape> =
        placed.iter().map(|(track, places)| track_curve(&chart, track, places)).collect();
    // The same interval for all tracks, so that outlines of the same number belong to the same
    // instant.
    let interval = mark_interval_s(0.5 * duration_s(&placed));
    inside.extend(
        placed
            .iter()
            .flat_map(|(track, places)| track_marks(&chart, track, places, hull, interval)),
    );
    let mut shapes = chart.draw_chart(inside);
    let first = placed.first().and_then(|(_, places)| places.first());
    shapes.extend(first.into_iter().flat_map(|place| chart.start_mark(*place)));
    let plot =
        SvgPlot { width: WIDTH, height: chart.plot_height(), label: label.to_owned(), shapes };
    Some(localize_plot(plot))
}

fn duration_s(placed: &[(&PlotTrack, Vec<(f64, f64)>)]) -> f64 {
    let of = |track: &PlotTrack| Some(track.t_s.last()? - track.t_s.first()?);
    placed.iter().filter_map(|(track, _)| of(track)).fold(0.0, f64::max)
}

fn track_curve(chart: &GroundChart, track: &PlotTrack, places: &[(f64, f64)]) -> Shape {
    let points: Vec<(f64, f64)> = places.iter().map(|place| chart.position_of(*place)).collect();
    Shape::Path {
        d: path_data(&points, |from, to| track.has_gap(from, to)),
        class: track.style.line,
    }
}

/// Returns outlines where heading and hull are known, otherwise dots.
fn track_marks(
    chart: &GroundChart,
    track: &PlotTrack,
    places: &[(f64, f64)],
    hull: Option<HullOutline>,
    interval: f64,
) -> Vec<Shape> {
    let heading = track.channels.get(&Channel::Psi);
    let number = |sample: usize| ((track.t_s[sample] - track.t_s[0]) / interval + 1e-9).floor();
    // The small offset keeps a sample at a whole multiple of the interval from falling short of it
    // by rounding.
    let due = |sample: &usize| *sample == 0 || number(*sample) > number(*sample - 1);
    let mark = |sample: usize| {
        let outline =
            || chart.ship_outline(hull?, places[sample], *heading?.get(sample)?, track.style.hull);
        let (at, class) = (chart.position_of(places[sample]), track.style.dot);
        outline().unwrap_or(Shape::Dot { at, radius: 1.4, class })
    };
    (0..places.len()).filter(due).map(mark).collect()
}
