//! Runs of samples, and fractions of samples by which a channel is judged.

/// Largest faulty fraction of a channel; with more, the filter rather than the samples is wrong.
pub(super) const MAX_FAULTY_FRACTION: f64 = 0.2;
/// Largest fraction of equal neighbours of a channel whose noise is above its resolution.
pub(super) const NOISY: f64 = 0.2;

/// First and past-the-end index of every run of set flags.
pub(super) fn flagged_runs(flags: &[bool]) -> Vec<(usize, usize)> {
    let (mut runs, mut k) = (Vec::new(), 0);
    while k < flags.len() {
        let end = (k..flags.len()).find(|&at| flags[at] != flags[k]).unwrap_or(flags.len());
        if flags[k] {
            runs.push((k, end));
        }
        k = end;
    }
    runs
}
