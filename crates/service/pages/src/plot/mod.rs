//! Plots of measured and simulated tracks: over the ground, and channels over time.

mod channels;
mod ground;
mod track;

pub(crate) use channels::{ExcludedInterval, TimePanels, plot_channels, plot_with_exclusions};
pub(crate) use ground::plot_ground;
pub(crate) use track::{LINES, PlotTrack, legend_entries};
