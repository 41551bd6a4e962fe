//! Plots of measured and simulated tracks: over the ground, and channels over time.

mod channels;
mod ground;
mod track;

pub(crate) use channels::channels;
pub(crate) use ground::ground;
pub(crate) use track::{LINES, Track, legend};
