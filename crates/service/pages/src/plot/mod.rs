//! Plots of measured and simulated tracks: over the ground, and channels over time.

mod channels;
mod ground;
mod track;

pub(crate) use channels::plot_channels;
pub(crate) use ground::plot_ground;
pub(crate) use track::{LINES, PlotTrack, legend_entries};
