//! Memory of the results of a tape's operations.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line of the processor.
const LINE: usize = 64;

/// Values of one quantity in every lane.
pub type Lanes<const N: usize> = [f64; N];

/// Result of each operation of a tape in every lane, kept from one evaluation to the next. The
/// memory is aligned to a cache line: an operation that reads a result which was just written
/// across the end of a line waits many times as long.
#[derive(Debug, Clone, Default)]
pub struct Slots<const N: usize> {
    room: Vec<f64>,
    start: usize,
    count: usize,
}

impl<const N: usize> Slots<N> {
    /// Changes the number of results; earlier results are lost if the memory grows.
    pub(super) fn resize(&mut self, count: usize) {
        // One cache line more than needed, so that the start can be aligned.
        let least = count * N + LINE / size_of::<f64>();
        if self.room.len() < least {
            self.room = vec![0.0; least];
            // Skips the elements before the first cache line of the allocation.
            self.start = self.room.as_ptr().align_offset(LINE).min(least - count * N);
        }
        self.count = count;
    }
}

impl<const N: usize> Deref for Slots<N> {
    type Target = [Lanes<N>];

    fn deref(&self) -> &[Lanes<N>] {
        &self.room[self.start..].as_chunks().0[..self.count]
    }
}

impl<const N: usize> DerefMut for Slots<N> {
    fn deref_mut(&mut self) -> &mut [Lanes<N>] {
        &mut self.room[self.start..].as_chunks_mut().0[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_begin_on_a_line_and_are_kept() {
        let mut slots = Slots::<8>::default();
        assert!(slots.is_empty());
        for count in [3, 1477, 5] {
            slots.resize(count);
            assert_eq!((slots.len(), slots.as_ptr().addr() % LINE), (count, 0));
            slots[count - 1] = [count as f64; 8];
        }
        slots.resize(1477);
        assert_eq!((slots[4], slots[1476]), ([5.0; 8], [1477.0; 8]));
    }
}
