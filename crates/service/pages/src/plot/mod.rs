//! Tracks over the ground and channels over time, of what was measured and what was simulated.

mod channels;
mod ground;
mod track;

pub(crate) use channels::channels;
pub(crate) use ground::ground;
pub(crate) use track::{LINES, Track, legend};
