//! Track over the ground, with the outline of the ship at the same instants on every track.

use sistership_model::trial::Channel;
use sistership_simulation::recorded::TrialReplay;
use sistership_simulation::state::at;

use super::axes::{display_range, nice_step, value_range};
use super::decimate::path_data;
use super::lines::{self, PlottedLine};
use super::{GroundChart, HullOutline, Shape, SvgPlot, WIDTH};
use crate::replayed::ReplayedTrial;

/// Returns the trajectory of one trial.
pub(crate) fn trajectory_plot(replayed: &ReplayedTrial<'_>) -> SvgPlot {
    let lines = lines::position_lines(replayed);
    let chart = ground_chart(&lines, replayed.hull);
    let mut inside: Vec<Shape> =
        lines.iter().map(|line| track_curve(&chart, replayed, line)).collect();
    inside.extend(lines.iter().flat_map(|line| time_marks(&chart, replayed, line)));
    let mut shapes = chart.draw_chart(inside);
    let first = lines.first().and_then(|line| line.values.first());
    shapes.extend(first.into_iter().flat_map(|place| chart.start_mark(*place)));
    SvgPlot {
        width: WIDTH,
        height: chart.plot_height(),
        label: format!("Trajectory of trial {}", replayed.trial.name),
        shapes,
    }
}

/// Time between the marks on a track, s.
pub fn mark_interval_s(duration_s: f64) -> f64 {
    nice_step((duration_s / 8.0).max(1e-3))
}

fn ground_chart(lines: &[PlottedLine<(f64, f64)>], hull: Option<HullOutline>) -> GroundChart {
    let range = |of: fn(&(f64, f64)) -> f64| {
        let own = |measured: bool| {
            let lines = lines.iter().filter(move |line| (line.class == "measured") == measured);
            value_range(lines.flat_map(|line| line.values.iter().map(of)))
        };
        display_range(own(true), own(false))
    };
    GroundChart::from_ranges(range(|point| point.0), range(|point| point.1), hull)
}

fn track_curve(
    chart: &GroundChart,
    replayed: &ReplayedTrial<'_>,
    line: &PlottedLine<(f64, f64)>,
) -> Shape {
    let starts = lines::segment_starts(replayed.trial);
    let points: Vec<(f64, f64)> =
        line.values.iter().map(|point| chart.position_of(*point)).collect();
    let jumps = |from: usize, to: usize| {
        lines::has_gap(replayed.trial, &starts, line.samples[from], line.samples[to])
    };
    Shape::Path { d: path_data(&points, jumps), class: line.class }
}

/// Marks of equal time: outlines if the heading is known, otherwise dots.
fn time_marks(
    chart: &GroundChart,
    replayed: &ReplayedTrial<'_>,
    line: &PlottedLine<(f64, f64)>,
) -> Vec<Shape> {
    let times = &replayed.trial.t_s;
    let interval = mark_interval_s(replayed.trial.duration_s());
    let number = |index: usize| ((times[line.samples[index]] - times[0]) / interval + 1e-9).floor();
    // A mark at the first sample of each interval.
    let crossed = |index: &usize| number(*index) > number(*index - 1);
    let mark = |index: usize| {
        let outline = || {
            let heading = heading_at(replayed, line, index)?;
            chart.ship_outline(replayed.hull?, line.values[index], heading, hull_class(line.class))
        };
        let (at, class) = (chart.position_of(line.values[index]), dot_class(line.class));
        // No heading, no hull or too small: a dot.
        outline().unwrap_or(Shape::Dot { at, radius: 2.6, class })
    };
    (1..line.values.len()).filter(crossed).map(mark).collect()
}

fn heading_at(
    replayed: &ReplayedTrial<'_>,
    line: &PlottedLine<(f64, f64)>,
    index: usize,
) -> Option<f64> {
    let of = |run: &TrialReplay| run.track.states.get(index).map(|state| state[at::PSI]);
    match line.class {
        // Simulated headings are indexed by the line's own samples, recorded ones by those of the
        // trial.
        "source" => of(&replayed.source),
        "refined" => of(&replayed.refined),
        _ => replayed.trial.channel(Channel::Psi)?.get(line.samples[index]).copied(),
    }
}

fn hull_class(line: &str) -> &'static str {
    match line {
        "source" => "hull source",
        "refined" => "hull refined",
        _ => "hull measured",
    }
}

fn dot_class(line: &str) -> &'static str {
    match line {
        "source" => "dot source",
        "refined" => "dot refined",
        _ => "dot measured",
    }
}
