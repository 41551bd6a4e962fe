//! Selection of the strength of the prior of an axis.

/// Index of the strongest prior whose error on held-out trials exceeds that of the best by no more,
/// in the mean, than one standard error of that difference over the trials (after Breiman et al.
/// 1984, Classification and regression trees, section 3.4.3): one-step errors alone would always
/// select the weakest prior. `errors[fold][k]` is the error at the k-th strength, from the weakest
/// on; `untold` is returned if there are fewer than two folds.
pub(super) fn strongest_within_one_error(
    errors: &[&[f64]],
    strengths: usize,
    untold: usize,
) -> usize {
    if errors.len() < 2 {
        return untold;
    }
    let folds = errors.len() as f64;
    let mean = |k: usize| errors.iter().map(|fold| fold[k]).sum::<f64>() / folds;
    let means: Vec<f64> = (0..strengths).map(mean).collect();
    let least = (0..strengths).min_by(|a, b| means[*a].total_cmp(&means[*b])).unwrap_or(untold);
    let as_good = |k: usize| {
        let more = means[k] - means[least];
        let spread: f64 = errors.iter().map(|fold| (fold[k] - fold[least] - more).powi(2)).sum();
        // Standard error of the mean difference over the folds.
        more <= (spread / ((folds - 1.0) * folds)).sqrt()
    };
    // From the strongest prior downwards; the best itself always qualifies.
    (least..strengths).rev().find(|k| as_good(*k)).unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_trials_do_not_tell_apart_goes_to_the_prior() {
        let choose =
            |errors: [[f64; 4]; 2]| strongest_within_one_error(&[&errors[0], &errors[1]], 4, 3);
        assert_eq!(
            choose([[4.0, 1.0, 1.5, 4.0], [5.0, 2.1, 2.5, 5.0]]),
            1,
            "both trials lose, whatever their own level"
        );
        assert_eq!(choose([[4.0, 1.0, 1.5, 4.0], [4.0, 1.1, 1.0, 4.1]]), 2, "one wins, one loses");
        assert_eq!(strongest_within_one_error(&[&[4.0, 1.0, 1.5, 4.0]], 4, 3), 3);
    }
}
