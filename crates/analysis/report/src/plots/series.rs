//! Time series of speeds, yaw rate, heading and rudder, one panel each.

use sistership_model::trial::Channel;

use super::axes::{AxisScale, display_range, grid_columns, grid_rows, padded_range, value_range};
use super::decimate::path_data;
use super::lines::{self, PlottedLine};
use super::{PanelAxes, Shape, SvgPlot, WIDTH};
use crate::replayed::ReplayedTrial;
use crate::words::{self, DisplayChannel, RUDDER};

const LEFT: f64 = 46.0;
const RIGHT: f64 = 18.0;
const TITLE: f64 = 20.0;
const HEIGHT: f64 = 78.0;
const BOTTOM: f64 = 34.0;

/// Returns the panels of one trial.
pub(crate) fn series_plot(replayed: &ReplayedTrial<'_>) -> SvgPlot {
    let panels = panel_channels(replayed.rolls);
    let (time, mut shapes) = (time_scale(replayed), Vec::new());
    for (index, (channel, quantity)) in panels.iter().enumerate() {
        let top = TITLE + index as f64 * (TITLE + HEIGHT);
        shapes.extend(channel_panel(
            replayed,
            *channel,
            *quantity,
            &time,
            top,
            index + 1 == panels.len(),
        ));
    }
    let height = panels.len() as f64 * (TITLE + HEIGHT) + BOTTOM;
    shapes.push(Shape::Text {
        at: (LEFT + time.length / 2.0, height - 4.0),
        text: "time [s]".into(),
        class: "title mid",
    });
    SvgPlot {
        width: WIDTH,
        height,
        label: format!("Time series of trial {}", replayed.trial.name),
        shapes,
    }
}

/// Displayed channels: the motions, then the rudder.
pub(super) fn panel_channels(rolls: bool) -> Vec<(Channel, DisplayChannel)> {
    let motions = [Channel::U, Channel::V, Channel::R, Channel::Psi, Channel::Phi];
    // Roll is only shown if it is simulated.
    let motions = motions.into_iter().filter(|channel| rolls || *channel != Channel::Phi);
    let mut panels: Vec<_> = motions
        .filter_map(|channel| Some((channel, words::find_channel(channel.name())?)))
        .collect();
    panels.push((Channel::Delta, RUDDER));
    panels
}

fn time_scale(replayed: &ReplayedTrial<'_>) -> AxisScale {
    let times = &replayed.trial.t_s;
    let (low, high) = value_range(times.iter().copied()).unwrap_or((0.0, 1.0));
    AxisScale { low, high: high.max(low + 1e-9), length: WIDTH - LEFT - RIGHT, reversed: false }
}

fn channel_panel(
    replayed: &ReplayedTrial<'_>,
    channel: Channel,
    quantity: DisplayChannel,
    time: &AxisScale,
    top: f64,
    last: bool,
) -> Vec<Shape> {
    let lines = lines::channel_lines(replayed, channel, quantity.factor);
    let range = |measured: bool| {
        // The measured line determines the range; the others extend it.
        let own = lines.iter().filter(|line| (line.class == "measured") == measured);
        value_range(own.flat_map(|line| line.values.iter().copied()))
    };
    let (low, high) = padded_range(display_range(range(true), range(false)), 0.06);
    let scale = AxisScale { low, high, length: HEIGHT, reversed: true };
    let given = if channel == Channel::Delta { ", input of both models" } else { "" };
    let title = format!("{} {} [{}]{given}", quantity.name, quantity.symbol, quantity.unit);
    let mut shapes = vec![Shape::Text { at: (LEFT, top - 6.0), text: title, class: "title" }];
    shapes.extend(grid_rows((LEFT, top), time.length, &scale, 5));
    shapes.extend(grid_columns((LEFT, top), HEIGHT, time, 6, last));
    let curves = lines.iter().map(|line| channel_curve(replayed, line, time, &scale)).collect();
    let axes = PanelAxes {
        quantity: channel.name().to_owned(),
        title: format!("{} {}", quantity.name, quantity.symbol),
        unit: quantity.unit,
        across: *time,
        up: scale,
    };
    let (at, size) = ((LEFT, top), (time.length, HEIGHT));
    shapes.push(Shape::Panel { at, size, shapes: curves, axes: Some(axes) });
    shapes.push(Shape::Rect { at: (LEFT, top), size: (time.length, HEIGHT), class: "frame" });
    shapes
}

fn channel_curve(
    replayed: &ReplayedTrial<'_>,
    line: &PlottedLine<f64>,
    time: &AxisScale,
    scale: &AxisScale,
) -> Shape {
    let starts = lines::segment_starts(replayed.trial);
    let place = |(value, sample): (&f64, &usize)| {
        (time.position_of(replayed.trial.t_s[*sample]), scale.position_of(*value))
    };
    let points: Vec<(f64, f64)> = line.values.iter().zip(&line.samples).map(place).collect();
    let jumps = |from: usize, to: usize| {
        lines::has_gap(replayed.trial, &starts, line.samples[from], line.samples[to])
    };
    Shape::Path { d: path_data(&points, jumps), class: line.class }
}
