//! Rows that repeat the row before: the recorder had nothing new.

use super::runs::{NOISY, flagged_runs};

/// Largest fraction of repeated rows; with more, the recorder is faster than its sensors.
const MAX_REPEATED_FRACTION: f64 = 0.1;
/// Expected number of repeated rows by chance in a recording.
const BY_CHANCE: f64 = 1e-3;

/// Returns the rows that repeat all values of the row before although the channels have noise.
pub fn repeated_rows(channels: &[&[f64]]) -> Vec<usize> {
    let rows = channels.first().map_or(0, |values| values.len());
    let repeats = |k: usize| channels.iter().all(|values| values[k] == values[k - 1]);
    let repeated: Vec<bool> = (0..rows).map(|k| k > 0 && repeats(k)).collect();
    let count = repeated.iter().filter(|one| **one).count();
    if count == 0 || count as f64 > MAX_REPEATED_FRACTION * rows as f64 {
        return Vec::new();
    }
    // Fraction of equal neighbours in the other rows: their product is the probability that a row is
    // repeated by chance.
    let others = (rows - count) as f64;
    let parts = channels.iter().map(|values| {
        let equal = (1..rows).filter(|&k| values[k] == values[k - 1] && !repeated[k]).count();
        (equal as f64 / others).max(1.0 / others)
    });
    let noisy: Vec<f64> = parts.filter(|part| *part <= NOISY).collect();
    if noisy.is_empty() || others * noisy.iter().product::<f64>() > BY_CHANCE {
        return Vec::new();
    }
    // A ship at rest, or a steady simulation, is recorded from the first row on.
    let later = flagged_runs(&repeated).into_iter().filter(|&(first, _)| first > 1);
    later.flat_map(|(first, end)| first..end).collect()
}
