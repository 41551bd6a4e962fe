//! Balanced samples: common samples are thinned out to the number of the rare ones (Kanazawa 2023,
//! sec. 3.4.1).

use crate::draws::RandomStream;

/// Returns the indices of the selected samples: all at or above a quantile of the measured values,
/// and as many of the others, drawn by a seed.
pub fn balance_samples(measured: &[f64], quantile: f64, seed: u64) -> Vec<usize> {
    let mut sorted = measured.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let place = (quantile * measured.len() as f64) as usize;
    // There is no quantile without samples.
    let Some(limit) = sorted.get(place.min(measured.len().saturating_sub(1))) else {
        return Vec::new();
    };
    let (rare, common): (Vec<usize>, Vec<usize>) =
        (0..measured.len()).partition(|k| measured[*k] >= *limit);
    let drawn = RandomStream::new(seed, 2).sample_indices(rare.len(), common.len());
    let mut kept: Vec<usize> = drawn.into_iter().map(|k| common[k as usize]).collect();
    kept.extend(rare);
    // In the order of the samples.
    kept.sort_unstable();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_common_samples_as_rare_ones_are_kept() {
        let measured: Vec<f64> = (0..100).map(|k| f64::from((37 * k) % 100)).collect();
        let kept = balance_samples(&measured, 0.9, 3);
        let rare = kept.iter().filter(|k| measured[**k] >= 90.0).count();
        assert_eq!((rare, kept.len()), (10, 20));
        assert_eq!(kept, balance_samples(&measured, 0.9, 3));
        assert_ne!(kept, balance_samples(&measured, 0.9, 4));
        assert!(balance_samples(&[], 0.9, 3).is_empty());
    }
}
