//! Channels over time, one panel below the other.

use sistership_model::trial::Channel;
use sistership_report::plots::axes::{
    AxisScale, grid_columns, grid_rows, padded_range, value_range,
};
use sistership_report::plots::{ChartLine, PanelAxes, Shape, SvgPlot, WIDTH, path_data};

use super::track::PlotTrack;

const LEFT: f64 = 46.0;
const RIGHT: f64 = 18.0;
const TITLE: f64 = 20.0;
const HEIGHT: f64 = 72.0;
const BOTTOM: f64 = 34.0;

/// Contents of a panel: channel, name, unit, and the factor from SI.
type ChannelPanel = (Channel, &'static str, &'static str, f64);

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

const PANELS: [ChannelPanel; 10] = [
    (Channel::U, "surge speed u", "m/s", 1.0),
    (Channel::V, "sway speed v", "m/s", 1.0),
    (Channel::R, "yaw rate r", "deg/s", DEGREES),
    (Channel::Psi, "heading ψ", "deg", DEGREES),
    (Channel::Phi, "roll φ", "deg", DEGREES),
    (Channel::Delta, "rudder δ", "deg", DEGREES),
    (Channel::N, "revolutions n", "1/min", 60.0),
    (Channel::WindSpeed, "true wind speed", "m/s", 1.0),
    (Channel::WindFrom, "true wind from", "deg", DEGREES),
    (Channel::Depth, "water depth", "m", 1.0),
];

/// Returns one panel for each channel that some track has; `label` describes the plot.
pub(crate) fn plot_channels(tracks: &[PlotTrack], label: &str) -> SvgPlot {
    let panels: Vec<ChannelPanel> =
        PANELS.into_iter().filter(|(channel, ..)| is_recorded(tracks, *channel)).collect();
    let (low, high) = value_range(tracks.iter().flat_map(|track| track.t_s.iter().copied()))
        .unwrap_or((0.0, 1.0));
    let length = WIDTH - LEFT - RIGHT;
    // A track of a single sample still needs a range above zero.
    let time = AxisScale { low, high: high.max(low + 1e-9), length, reversed: false };
    let mut shapes = Vec::new();
    for (index, one) in panels.iter().enumerate() {
        let top = TITLE + index as f64 * (TITLE + HEIGHT);
        shapes.extend(panel_shapes(tracks, *one, &time, top, index + 1 == panels.len()));
    }
    let height = panels.len() as f64 * (TITLE + HEIGHT) + BOTTOM;
    let at = (LEFT + 0.5 * length, height - 4.0);
    shapes.push(Shape::Text { at, text: "time [s]".into(), class: "title mid" });
    SvgPlot { width: WIDTH, height, label: label.to_owned(), shapes }
}

/// Returns the values of a track in the units of the panels, with its positions.
pub(super) fn chart_line(track: &PlotTrack) -> ChartLine {
    let shown = PANELS.into_iter().map(|(channel, _, _, factor)| (channel, factor));
    let all = [(Channel::X, 1.0), (Channel::Y, 1.0)].into_iter().chain(shown);
    let quantity = |(channel, factor): (Channel, f64)| {
        let values = track.channels.get(&channel)?;
        Some((channel.name().to_owned(), values.iter().map(|value| value * factor).collect()))
    };
    ChartLine {
        class: track.style.name,
        name: track.name.clone(),
        t_s: track.t_s.clone(),
        quantities: all.filter_map(quantity).collect(),
    }
}

/// Returns true if some track has the channel. Revolutions that were not recorded are all zero.
fn is_recorded(tracks: &[PlotTrack], channel: Channel) -> bool {
    let there =
        |values: &Vec<f64>| channel != Channel::N || values.iter().any(|value| *value != 0.0);
    tracks.iter().any(|track| track.channels.get(&channel).is_some_and(there))
}

/// Widens the range of an almost constant channel to 2 % of its value, as the last digits mean
/// nothing.
fn widen_range((low, high): (f64, f64)) -> (f64, f64) {
    let room = 0.5 * (0.02 * low.abs().max(high.abs()) - (high - low)).max(0.0);
    (low - room, high + room)
}

fn panel_shapes(
    tracks: &[PlotTrack],
    (channel, name, unit, factor): ChannelPanel,
    time: &AxisScale,
    top: f64,
    last: bool,
) -> Vec<Shape> {
    let all = tracks.iter().filter_map(|track| Some((track, track.channels.get(&channel)?)));
    let lines: Vec<(&PlotTrack, &Vec<f64>)> = all.collect();
    let values = lines.iter().flat_map(|(_, values)| values.iter().map(|value| value * factor));
    let (low, high) = padded_range(widen_range(value_range(values).unwrap_or((0.0, 1.0))), 0.06);
    let scale = AxisScale { low, high, length: HEIGHT, reversed: true };
    let (at, size) = ((LEFT, top), (time.length, HEIGHT));
    let title = format!("{name} [{unit}]");
    let mut shapes = vec![Shape::Text { at: (LEFT, top - 6.0), text: title, class: "title" }];
    shapes.extend(grid_rows(at, time.length, &scale, 4));
    shapes.extend(grid_columns(at, HEIGHT, time, 6, last));
    let curve = |(track, values): &(&PlotTrack, &Vec<f64>)| {
        let place =
            |(t, value): (&f64, &f64)| (time.position_of(*t), scale.position_of(value * factor));
        let points: Vec<(f64, f64)> = track.t_s.iter().zip(*values).map(place).collect();
        Shape::Path {
            d: path_data(&points, |from, to| track.has_gap(from, to)),
            class: track.style.line,
        }
    };
    let axes = PanelAxes {
        quantity: channel.name().to_owned(),
        title: name.to_owned(),
        unit,
        across: *time,
        up: scale,
    };
    let shapes_inside = lines.iter().map(curve).collect();
    shapes.push(Shape::Panel { at, size, shapes: shapes_inside, axes: Some(axes) });
    shapes.push(Shape::Rect { at, size, class: "frame" });
    shapes
}
