//! Sums over blocks of samples, on which the physical checks are based.
//!
//! Integrals over a block rather than differences of samples suppress measurement noise.

use crate::recording::Recording;

/// Number of blocks of a recording for a comparison.
const BLOCKS: usize = 100;

/// First and last sample of a block without a gap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SampleBlock {
    pub first: usize,
    pub last: usize,
}

/// Returns about a hundred consecutive blocks of equal length within the segments.
pub(crate) fn sample_blocks(recording: &Recording) -> Vec<SampleBlock> {
    let steps = (recording.trial.len() / BLOCKS).max(1);
    let inside = |segment: &std::ops::Range<usize>| {
        (segment.start..segment.end)
            .step_by(steps)
            .map(move |first| SampleBlock { first, last: first + steps })
    };
    // An incomplete block at the end of a segment is dropped.
    let fits = |block: &SampleBlock, end: usize| block.last < end;
    recording
        .segments
        .iter()
        .flat_map(|segment| inside(segment).filter(|block| fits(block, segment.end)))
        .collect()
}

impl SampleBlock {
    /// Returns the trapezoidal integral over time of a function of the sample.
    pub(crate) fn time_integral(self, t: &[f64], value: impl Fn(usize) -> f64) -> f64 {
        (self.first..self.last).map(|k| 0.5 * (value(k) + value(k + 1)) * (t[k + 1] - t[k])).sum()
    }

    /// Returns the change from the first to the last sample.
    pub(crate) fn total_change(self, values: &[f64]) -> f64 {
        values[self.last] - values[self.first]
    }
}

/// Proportionality of two series without offset: `b = slope a`, and their correlation about zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProportionalFit {
    pub slope: f64,
    pub correlation: f64,
}

pub(crate) fn fit_proportion(pairs: &[(f64, f64)]) -> Option<ProportionalFit> {
    let sum = |term: fn(f64, f64) -> f64| pairs.iter().map(|&(a, b)| term(a, b)).sum::<f64>();
    let (aa, ab, bb) = (sum(|a, _| a * a), sum(|a, b| a * b), sum(|_, b| b * b));
    (pairs.len() >= 3 && aa > 0.0 && bb > 0.0)
        .then(|| ProportionalFit { slope: ab / aa, correlation: ab / (aa * bb).sqrt() })
}

/// Returns Pearson's correlation of pairs; zero if one side is constant or there are fewer than
/// three. The iterator is cloned for several passes.
pub(crate) fn pearson_correlation(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let count = pairs.clone().count();
    let n = count.max(1) as f64;
    let (mean_a, mean_b) =
        pairs.clone().fold((0.0, 0.0), |(a, b), pair| (a + pair.0 / n, b + pair.1 / n));
    let add = |(aa, ab, bb), (a, b)| {
        let (a, b): (f64, f64) = (a - mean_a, b - mean_b);
        (aa + a * a, ab + a * b, bb + b * b)
    };
    let (aa, ab, bb) = pairs.fold((0.0, 0.0, 0.0), add);
    if count >= 3 && aa > 0.0 && bb > 0.0 { ab / (aa * bb).sqrt() } else { 0.0 }
}

/// Returns the largest less the smallest value.
pub(crate) fn value_range(values: &[f64]) -> f64 {
    iter_range(values.iter().copied())
}

/// Returns the largest less the smallest value of an iterator; zero for none.
pub(crate) fn iter_range(values: impl Iterator<Item = f64>) -> f64 {
    let bounds = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (bounds.1 - bounds.0).max(0.0)
}

/// Number of bits that one pass over the values determines.
const DIGIT: u32 = 16;

/// Returns the quantile of the values by nearest rank; zero for none. It is found digit by digit in
/// four passes: a copy of a column for sorting would be as large as the column.
pub(crate) fn nearest_quantile(values: impl Iterator<Item = f64> + Clone, fraction: f64) -> f64 {
    let last = values.clone().count().saturating_sub(1);
    let mut rank = ((last as f64 * fraction).round() as usize).min(last);
    let (mut found, mut counts) = (0_u64, vec![0_usize; 1 << DIGIT]);
    for shift in (0..u64::BITS).step_by(DIGIT as usize).rev() {
        counts.fill(0);
        // Only values that agree with the digits found so far are counted by their next digit.
        let above = |key: u64| key.checked_shr(shift + DIGIT).unwrap_or(0);
        let alike = values.clone().map(ordered_bits).filter(|&key| above(key) == above(found));
        alike.for_each(|key| counts[(key >> shift) as usize & ((1 << DIGIT) - 1)] += 1);
        let Some(digit) = counts.iter().position(|&count| {
            let here = rank < count;
            rank -= if here { 0 } else { count };
            here
        }) else {
            return 0.0;
        };
        found |= (digit as u64) << shift;
    }
    // Inverse of `ordered_bits`.
    f64::from_bits(if found >> 63 == 1 { found & !(1 << 63) } else { !found })
}

/// Returns bits whose order as integers is that of the numbers.
fn ordered_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::test_recording;
    use sistership_model::trial::Channel;

    #[test]
    fn blocks_stay_within_segments() {
        let mut recording = test_recording(&[(Channel::U, vec![1.0; 450])]);
        recording.segments = vec![0..10, 10..450];
        let blocks = sample_blocks(&recording);
        assert!(blocks.iter().all(|block| block.last < 10 || block.first >= 10));
        assert_eq!((blocks[0].first, blocks[0].last, blocks[2].first), (0, 4, 10));
        assert_eq!(blocks[0].time_integral(recording.time(), |_| 2.0), 4.0);
    }

    #[test]
    fn quantiles_are_those_of_sorted_values() {
        let mut values: Vec<f64> =
            (0..1000).map(|k| f64::from(k * 7919 % 1000 - 500).powi(3) * 1e-3).collect();
        values.extend([0.0, -0.0, 1e300, -1e-300, f64::MAX]);
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        for fraction in [0.0, 0.05, 0.5, 0.95, 1.0] {
            let at = ((sorted.len() - 1) as f64 * fraction).round() as usize;
            assert_eq!(
                nearest_quantile(values.iter().copied(), fraction).to_bits(),
                sorted[at].to_bits(),
                "{fraction}"
            );
        }
    }

    #[test]
    fn quantiles_and_correlations() {
        assert_eq!(nearest_quantile([3.0, 1.0, 2.0].into_iter(), 0.5), 2.0);
        assert_eq!(nearest_quantile(std::iter::empty(), 0.5), 0.0);
        assert!(
            (pearson_correlation([(0.0, 5.0), (1.0, 3.0), (2.0, 1.0)].into_iter()) + 1.0).abs()
                < 1e-12
        );
        assert_eq!(pearson_correlation([(1.0, 5.0), (1.0, 3.0), (1.0, 1.0)].into_iter()), 0.0);
        assert_eq!(value_range(&[1.0, -2.0]), 3.0);
    }
}
