//! Charts of measured and simulated tracks: over the ground, and channels over time.

mod channels;
mod ground;
mod track;

use sistership_report::plots::{ChartLine, HullOutline, LiveChart};

pub(crate) use channels::{ExcludedInterval, TimePanels, plot_channels, plot_with_exclusions};
pub(crate) use ground::plot_ground;
pub(crate) use track::{LINES, PlotTrack};

use crate::language::say;

/// Returns a chart of tracks over the ground, if they have positions, and of their channels;
/// `label` describes it.
pub(crate) fn track_chart(
    tracks: &[PlotTrack],
    hull: Option<HullOutline>,
    label: &str,
) -> LiveChart {
    let ground = plot_ground(tracks, hull, &say("plot-track").with("label", label).to_string());
    let over_time = plot_channels(tracks, &say("plot-over-time").with("label", label).to_string());
    let lines: Vec<ChartLine> = tracks.iter().map(channels::chart_line).collect();
    LiveChart::new(ground.into_iter().chain([over_time]).collect(), &lines, hull)
}
