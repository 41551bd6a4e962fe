//! Samples of a path that are evaluated together.

use sistership_simulation::tape::LaneValues;

/// Number of samples in a block.
pub(super) const LANES: usize = 8;

/// Returns one value for each sample of a block.
#[inline(always)]
pub(super) fn fill_lanes(of: impl FnMut(usize) -> f64) -> LaneValues<LANES> {
    std::array::from_fn(of)
}
