//! Samples of a path that are looked at together.

use sistership_simulation::tape::Lanes;

/// How many.
pub(super) const LANES: usize = 8;

/// A value for each.
#[inline(always)]
pub(super) fn lanes(of: impl FnMut(usize) -> f64) -> Lanes<LANES> {
    std::array::from_fn(of)
}
