//! Reproducible random numbers: ChaCha is specified to the bit, and the conversion of its words is
//! written here, as libraries change theirs from version to version.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// Stream of random numbers.
pub struct RandomStream(ChaCha12Rng);

impl RandomStream {
    /// Creates one of the independent streams of a seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        rng.set_stream(stream);
        Self(rng)
    }

    /// Returns a whole number below `n`.
    pub fn integer_below(&mut self, n: usize) -> usize {
        // Upper half of the product of a 64-bit word and `n`.
        ((u128::from(self.0.next_u64()) * n as u128) >> 64) as usize
    }

    /// Returns a number between -1 and 1.
    pub fn signed_unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns `count` numbers of `0..n`, each at most once, in random order.
    pub fn sample_indices(&mut self, count: usize, n: usize) -> Vec<u32> {
        let mut all: Vec<u32> = (0..n as u32).collect();
        // The first `count` steps of a Fisher-Yates shuffle.
        let count = count.min(n);
        (0..count).for_each(|k| {
            let other = k + self.integer_below(n - k);
            all.swap(k, other);
        });
        all.truncate(count);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_repeat_and_differ() {
        let first = |stream| RandomStream::new(7, stream).sample_indices(5, 100);
        assert_eq!(first(1), first(1));
        assert_ne!(first(1), first(2));
        let mut all = RandomStream::new(1, 0).sample_indices(50, 50);
        all.sort_unstable();
        assert_eq!(all, (0..50).collect::<Vec<u32>>());
    }

    #[test]
    fn numbers_keep_to_their_range() {
        let mut draws = RandomStream::new(3, 3);
        assert!((0..1000).all(|_| draws.integer_below(3) < 3 && draws.signed_unit().abs() <= 1.0));
    }
}
