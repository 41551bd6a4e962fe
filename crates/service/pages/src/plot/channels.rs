//! Channels over time, one panel below the other.

use sistership_model::trial::Channel;
use sistership_report::plots::axes::{
    AxisScale, grid_columns, grid_rows, padded_range, value_range,
};
use sistership_report::plots::{ChartLine, PanelAxes, Shape, SvgPlot, WIDTH, path_data};

use super::track::PlotTrack;
use crate::language::{say, say_word};
use crate::picture::localize_plot;

const LEFT: f64 = 46.0;
const RIGHT: f64 = 18.0;
const TITLE: f64 = 20.0;
const HEIGHT: f64 = 72.0;
const BOTTOM: f64 = 34.0;
/// Smallest width of a shaded interval, in units of the plot.
const THINNEST: f64 = 1.6;

/// Contents of a panel: channel, unit, and the factor from SI.
type ChannelPanel = (Channel, &'static str, f64);

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

const PANELS: [ChannelPanel; 10] = [
    (Channel::U, "m/s", 1.0),
    (Channel::V, "m/s", 1.0),
    (Channel::R, "deg/s", DEGREES),
    (Channel::Psi, "deg", DEGREES),
    (Channel::Phi, "deg", DEGREES),
    (Channel::Delta, "deg", DEGREES),
    (Channel::N, "1/min", 60.0),
    (Channel::WindSpeed, "m/s", 1.0),
    (Channel::WindFrom, "deg", DEGREES),
    (Channel::Depth, "m", 1.0),
];

/// Further panels of an upload, in which each channel that was read can be reviewed.
const FURTHER: [ChannelPanel; 9] = [
    (Channel::X, "m", 1.0),
    (Channel::Y, "m", 1.0),
    (Channel::P, "deg/s", DEGREES),
    (Channel::UWater, "m/s", 1.0),
    (Channel::VWater, "m/s", 1.0),
    (Channel::DeltaS, "deg", DEGREES),
    (Channel::DeltaP, "deg", DEGREES),
    (Channel::NS, "1/min", 60.0),
    (Channel::NP, "1/min", 60.0),
];

/// Interval of time in which values of a channel, or of every channel, are excluded, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ExcludedInterval {
    /// Channel; `None` for whole rows.
    pub channel: Option<Channel>,
    pub from_s: f64,
    pub to_s: f64,
}

/// Place of the time axis in a plot of channels, by which a click becomes a time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct TimePanels {
    /// Times at the ends of the axis, s.
    pub from_s: f64,
    pub to_s: f64,
    /// Ends of the axis, in units of the plot.
    pub left: f64,
    pub right: f64,
    /// Width of the plot, and height of a panel with its title.
    pub width: f64,
    pub panel: f64,
    /// Names of the channels from top to bottom, with spaces between them.
    pub channels: String,
}

/// Returns one panel for each channel that some track has; `label` describes the plot.
pub(crate) fn plot_channels(tracks: &[PlotTrack], label: &str) -> SvgPlot {
    ChannelPlot::new(tracks, PANELS, &[]).draw(label)
}

/// Returns the panels of every channel, with what is excluded shaded, and the place of their axis.
pub(crate) fn plot_with_exclusions(
    tracks: &[PlotTrack],
    excluded: &[ExcludedInterval],
    label: &str,
) -> (SvgPlot, TimePanels) {
    let plot = ChannelPlot::new(tracks, PANELS.into_iter().chain(FURTHER), excluded);
    (plot.draw(label), plot.time_panels())
}

/// Plot of channels over a common axis of time.
struct ChannelPlot<'a> {
    tracks: &'a [PlotTrack],
    panels: Vec<ChannelPanel>,
    excluded: &'a [ExcludedInterval],
    time: AxisScale,
}

impl<'a> ChannelPlot<'a> {
    fn new(
        tracks: &'a [PlotTrack],
        panels: impl IntoIterator<Item = ChannelPanel>,
        excluded: &'a [ExcludedInterval],
    ) -> Self {
        let panels = panels.into_iter().filter(|(channel, ..)| is_recorded(tracks, *channel));
        let (low, high) = value_range(tracks.iter().flat_map(|track| track.t_s.iter().copied()))
            .unwrap_or((0.0, 1.0));
        let length = WIDTH - LEFT - RIGHT;
        // A track of a single sample still needs a range above zero.
        let time = AxisScale { low, high: high.max(low + 1e-9), length, reversed: false };
        Self { tracks, panels: panels.collect(), excluded, time }
    }

    fn draw(&self, label: &str) -> SvgPlot {
        let mut shapes = Vec::new();
        for (index, one) in self.panels.iter().enumerate() {
            let top = TITLE + index as f64 * (TITLE + HEIGHT);
            shapes.extend(self.panel_shapes(*one, top, index + 1 == self.panels.len()));
        }
        let height = self.panels.len() as f64 * (TITLE + HEIGHT) + BOTTOM;
        let at = (LEFT + 0.5 * self.time.length, height - 4.0);
        shapes.push(Shape::Text { at, text: say("plot-time").into(), class: "title mid" });
        localize_plot(SvgPlot { width: WIDTH, height, label: label.to_owned(), shapes })
    }

    fn time_panels(&self) -> TimePanels {
        let names: Vec<&str> = self.panels.iter().map(|(channel, ..)| channel.name()).collect();
        TimePanels {
            from_s: self.time.low,
            to_s: self.time.high,
            left: LEFT,
            right: LEFT + self.time.length,
            width: WIDTH,
            panel: TITLE + HEIGHT,
            channels: names.join(" "),
        }
    }

    /// Returns the shaded intervals of a channel, in units of the plot, in ascending order; those
    /// that touch each other are merged.
    fn shaded_intervals(&self, channel: Channel) -> Vec<(f64, f64)> {
        let own = self.excluded.iter().filter(|one| one.channel.is_none_or(|of| of == channel));
        let place = |one: &ExcludedInterval| {
            let (from, to) = (self.time.position_of(one.from_s), self.time.position_of(one.to_s));
            // A single sample has no length, and must still be seen.
            (from - 0.5 * THINNEST, to + 0.5 * THINNEST)
        };
        let mut all: Vec<(f64, f64)> = own.map(place).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut merged: Vec<(f64, f64)> = Vec::new();
        for (from, to) in all {
            match merged.last_mut().filter(|last| from <= last.1) {
                Some(last) => last.1 = last.1.max(to),
                None => merged.push((from, to)),
            }
        }
        merged
    }

    fn panel_shapes(
        &self,
        (channel, unit, factor): ChannelPanel,
        top: f64,
        last: bool,
    ) -> Vec<Shape> {
        let time = &self.time;
        let all =
            self.tracks.iter().filter_map(|track| Some((track, track.channels.get(&channel)?)));
        let lines: Vec<(&PlotTrack, &Vec<f64>)> = all.collect();
        let values = lines.iter().flat_map(|(_, values)| values.iter().map(|value| value * factor));
        let (low, high) =
            padded_range(widen_range(value_range(values).unwrap_or((0.0, 1.0))), 0.06);
        let scale = AxisScale { low, high, length: HEIGHT, reversed: true };
        let (at, size) = ((LEFT, top), (time.length, HEIGHT));
        let name = say_word("channel", channel.name());
        let title = format!("{name} [{}]", say_word("unit", unit));
        let mut shapes = vec![Shape::Text { at: (LEFT, top - 6.0), text: title, class: "title" }];
        shapes.extend(grid_rows(at, time.length, &scale, 4));
        shapes.extend(grid_columns(at, HEIGHT, time, 6, last));
        let curve = |(track, values): &(&PlotTrack, &Vec<f64>)| {
            let place = |(t, value): (&f64, &f64)| {
                (time.position_of(*t), scale.position_of(value * factor))
            };
            let points: Vec<(f64, f64)> = track.t_s.iter().zip(*values).map(place).collect();
            Shape::Path {
                d: path_data(&points, |from, to| track.has_gap(from, to)),
                class: track.style.line,
            }
        };
        let shaded = self.shaded_intervals(channel).into_iter().map(|(from, to)| Shape::Rect {
            at: (from, 0.0),
            size: (to - from, HEIGHT),
            class: "excluded",
        });
        let inside = shaded.chain(lines.iter().map(curve)).collect();
        let axes = PanelAxes {
            quantity: channel.name().to_owned(),
            title: name,
            unit,
            across: *time,
            up: scale,
        };
        shapes.push(Shape::Panel { at, size, shapes: inside, axes: Some(axes) });
        shapes.push(Shape::Rect { at, size, class: "frame" });
        shapes
    }
}

/// Returns the values of a track in the units of the panels, with its positions.
pub(super) fn chart_line(track: &PlotTrack) -> ChartLine {
    let shown = PANELS.into_iter().map(|(channel, _, factor)| (channel, factor));
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
