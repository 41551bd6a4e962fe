//! Statistics of several trials as one.

use sistership_regression::Moments;

/// The statistics of some trials together, one set per regression.
pub(super) fn merged(
    moments: &[Vec<Moments>],
    keep: impl Fn(usize) -> bool,
) -> Option<Vec<Moments>> {
    let kept: Vec<&Vec<Moments>> =
        moments.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, m)| m).collect();
    let blocks = kept.first()?.len();
    (0..blocks).map(|block| Moments::sum(kept.iter().map(|m| &m[block]))).collect()
}
