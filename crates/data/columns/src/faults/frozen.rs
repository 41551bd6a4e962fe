//! Frozen sensors: runs of one value that are too long for the noise and the resolution of the
//! channel.

use super::filter::RobustFilter;
use super::runs::{NOISY, flagged_runs};

/// Minimum number of equal values in a run that may be a frozen sensor, and the expected number of
/// such runs by chance in a recording.
const FROZEN: usize = 5;
const BY_CHANCE: f64 = 1e-3;
/// Largest fraction of equal neighbours of a channel that may be found frozen by its rate.
const HELD: f64 = 0.95;
/// Number of samples on each side of a run in which the channel has to be noisy, and the least
/// fraction of alternating second differences: three standard deviations below that of white noise.
const AROUND: usize = 20;
const ALTERNATING: f64 = 0.4;

/// Returns the samples of runs of one value that are too long for chance, and before and after which
/// the channel is noisy, or which its rate contradicts.
pub(super) fn frozen_samples(values: &[f64], filter: &RobustFilter) -> Vec<usize> {
    let equal: Vec<bool> = (0..values.len()).map(|k| k > 0 && values[k] == values[k - 1]).collect();
    let part = equal_fraction(&equal);
    if part > HELD {
        return Vec::new();
    }
    let longest = FROZEN.max(chance_length(part, values.len()));
    let runs = flagged_runs(&equal).into_iter().filter(|&(first, end)| end - first >= longest);
    // A run of one value is a fault by itself where the noise is above the resolution.
    let is_frozen = |&(first, end): &(usize, usize)| match part <= NOISY {
        true => is_noisy_around(values, first, end),
        false => filter.is_rated && leaps_at_end(values, filter, first, end),
    };
    runs.filter(is_frozen).flat_map(|(first, end)| first..end).collect()
}

/// Returns the length of a run of which fewer than [`BY_CHANCE`] are expected: with the fraction p of
/// equal neighbours there are about n p^L runs of length L among n samples.
fn chance_length(part: f64, samples: usize) -> usize {
    ((BY_CHANCE / samples as f64).ln() / part.max(1e-4).ln()).ceil() as usize
}

fn equal_fraction(equal: &[bool]) -> f64 {
    equal.iter().filter(|equal| **equal).count() as f64 / equal.len().max(1) as f64
}

/// Returns true if the channel is noisy both before and after a run. Otherwise the ship is at rest,
/// or the readings are interpolated or filtered, so that a run of one value may be a motion.
fn is_noisy_around(values: &[f64], first: usize, end: usize) -> bool {
    // The first sample of a run has an equal predecessor, so that the run begins one before.
    let before = &values[first.saturating_sub(1 + AROUND)..first - 1];
    let after = &values[end.min(values.len())..(end + AROUND).min(values.len())];
    alternating_fraction(before) >= ALTERNATING && alternating_fraction(after) >= ALTERNATING
}

/// Returns the fraction of neighbouring second differences with opposite signs: 0.73 of white noise,
/// whatever the trend, and zero of a straight line or a decay.
fn alternating_fraction(values: &[f64]) -> f64 {
    let curves: Vec<f64> =
        values.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect();
    let alternating = curves.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    alternating as f64 / curves.len().saturating_sub(1).max(1) as f64
}

/// Returns true if the channel goes on at another value than its rate would have led to.
fn leaps_at_end(values: &[f64], filter: &RobustFilter, first: usize, end: usize) -> bool {
    let Some(&next) = values.get(end) else { return false };
    let moved = filter.wrap_change(filter.values[end] - filter.values[first - 1]);
    next != values[first] && moved.abs() > filter.gate
}
