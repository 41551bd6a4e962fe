//! Memory of the results of a tape's operations.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line of the processor.
const CACHE_LINE: usize = 64;

/// Values of one quantity in every lane.
pub type LaneValues<const N: usize> = [f64; N];

/// Result of each operation of a tape in every lane, kept from one evaluation to the next. The
/// memory is aligned to a cache line: an operation that reads a result which was just written
/// across the end of a line waits many times as long.
#[derive(Debug, Clone, Default)]
pub struct TapeResults<const N: usize> {
    room: Vec<f64>,
    start: usize,
    count: usize,
}

impl<const N: usize> TapeResults<N> {
    /// Changes the number of results; earlier results are lost if the memory grows.
    pub(super) fn resize_to(&mut self, count: usize) {
        // One cache line more than needed, so that the start can be aligned.
        let least = count * N + CACHE_LINE / size_of::<f64>();
        if self.room.len() < least {
            self.room = vec![0.0; least];
            // Skips the elements before the first cache line of the allocation.
            self.start = self.room.as_ptr().align_offset(CACHE_LINE).min(least - count * N);
        }
        self.count = count;
    }
}

impl<const N: usize> Deref for TapeResults<N> {
    type Target = [LaneValues<N>];

    fn deref(&self) -> &[LaneValues<N>] {
        &self.room[self.start..].as_chunks().0[..self.count]
    }
}

impl<const N: usize> DerefMut for TapeResults<N> {
    fn deref_mut(&mut self) -> &mut [LaneValues<N>] {
        &mut self.room[self.start..].as_chunks_mut().0[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_begin_on_a_line_and_are_kept() {
        let mut slots = TapeResults::<8>::default();
        assert!(slots.is_empty());
        for count in [3, 1477, 5] {
            slots.resize_to(count);
            assert_eq!((slots.len(), slots.as_ptr().addr() % CACHE_LINE), (count, 0));
            slots[count - 1] = [count as f64; 8];
        }
        slots.resize_to(1477);
        assert_eq!((slots[4], slots[1476]), ([5.0; 8], [1477.0; 8]));
    }
}
