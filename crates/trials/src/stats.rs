//! Sums over blocks of samples, on which the physical checks stand.
//!
//! Integrating over a block rather than differentiating samples keeps measurement noise out of the comparison.

use crate::recording::Recording;

/// Blocks that a recording is cut into for a comparison.
const BLOCKS: usize = 100;

/// First and last sample of a stretch without a gap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    pub first: usize,
    pub last: usize,
}

/// About a hundred blocks of equal length that follow each other within the segments.
pub(crate) fn blocks(recording: &Recording) -> Vec<Block> {
    let steps = (recording.trial.len() / BLOCKS).max(1);
    let inside = |segment: &std::ops::Range<usize>| {
        (segment.start..segment.end).step_by(steps).map(move |first| Block { first, last: first + steps })
    };
    let fits = |block: &Block, end: usize| block.last < end;
    recording.segments.iter().flat_map(|segment| inside(segment).filter(|block| fits(block, segment.end))).collect()
}

impl Block {
    /// Trapezoidal integral over time of a function of the sample.
    pub(crate) fn integral(self, t: &[f64], value: impl Fn(usize) -> f64) -> f64 {
        (self.first..self.last).map(|k| 0.5 * (value(k) + value(k + 1)) * (t[k + 1] - t[k])).sum()
    }

    /// Change from first to last sample.
    pub(crate) fn change(self, values: &[f64]) -> f64 {
        values[self.last] - values[self.first]
    }
}

/// How one series follows another without an offset: `b = slope a`, and the correlation of the two about zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proportion {
    pub slope: f64,
    pub correlation: f64,
}

pub(crate) fn proportion(pairs: &[(f64, f64)]) -> Option<Proportion> {
    let sum = |term: fn(f64, f64) -> f64| pairs.iter().map(|&(a, b)| term(a, b)).sum::<f64>();
    let (aa, ab, bb) = (sum(|a, _| a * a), sum(|a, b| a * b), sum(|_, b| b * b));
    (pairs.len() >= 3 && aa > 0.0 && bb > 0.0).then(|| Proportion { slope: ab / aa, correlation: ab / (aa * bb).sqrt() })
}

/// Pearson's correlation; zero where one side is constant.
pub(crate) fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let n = pairs.len().max(1) as f64;
    let (mean_a, mean_b) = pairs.iter().fold((0.0, 0.0), |(a, b), pair| (a + pair.0 / n, b + pair.1 / n));
    let centred: Vec<(f64, f64)> = pairs.iter().map(|&(a, b)| (a - mean_a, b - mean_b)).collect();
    proportion(&centred).map_or(0.0, |found| found.correlation)
}

/// Largest less smallest.
pub(crate) fn range(values: &[f64]) -> f64 {
    let bounds = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
    (bounds.1 - bounds.0).max(0.0)
}

/// The value below which the fraction of values lies; zero for none.
pub(crate) fn quantile(mut values: Vec<f64>, fraction: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    let at = ((last as f64 * fraction).round() as usize).min(last);
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(at, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::recording;
    use sistership_model::trial::Channel;

    #[test]
    fn blocks_stay_within_segments() {
        let mut recording = recording(&[(Channel::U, vec![1.0; 450])]);
        recording.segments = vec![0..10, 10..450];
        let blocks = blocks(&recording);
        assert!(blocks.iter().all(|block| block.last < 10 || block.first >= 10));
        assert_eq!((blocks[0].first, blocks[0].last, blocks[2].first), (0, 4, 10));
        assert_eq!(blocks[0].integral(recording.time(), |_| 2.0), 4.0);
    }

    #[test]
    fn quantiles_and_correlations() {
        assert_eq!(quantile(vec![3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(Vec::new(), 0.5), 0.0);
        assert!((correlation(&[(0.0, 5.0), (1.0, 3.0), (2.0, 1.0)]) + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&[(1.0, 5.0), (1.0, 3.0), (1.0, 1.0)]), 0.0);
        assert_eq!(range(&[1.0, -2.0]), 3.0);
    }
}
