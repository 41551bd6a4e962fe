//! The choice among evaluated candidates, by errors on the same held-out trials.
//!
//! Candidates are compared by the logarithm of the mean error, whose differences are ratios of
//! errors. Its scatter over the trials is estimated by the jackknife (Efron and Tibshirani 1993, An
//! introduction to the bootstrap, Eq. 11.5).

use std::collections::BTreeMap;

use sistership_identification::refine::CandidateEvaluation;

use crate::thresholds::SEARCH;
use sistership_assessment::uncertainty::student_quantile;

/// Smallest error; the logarithm of a smaller one would decide alone.
const MIN_ERROR: f64 = 1e-9;

/// Logarithm of a mean error, and the same without each trial.
struct LogError {
    all: f64,
    without: Vec<f64>,
}

impl LogError {
    fn from_errors(each: &BTreeMap<String, f64>) -> Self {
        let (sum, count) = (each.values().sum::<f64>(), each.len() as f64);
        let without = |error: &f64| ((sum - error).max(0.0) / (count - 1.0)).max(MIN_ERROR).ln();
        Self {
            all: (sum / count).max(MIN_ERROR).ln(),
            without: each.values().map(without).collect(),
        }
    }

    /// Standard error of the difference to another; `None` for a single trial, which has no
    /// scatter.
    fn standard_error(&self, other: &[f64]) -> Option<f64> {
        let differences: Vec<f64> =
            self.without.iter().zip(other).map(|(one, other)| one - other).collect();
        let count = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / count;
        let squares = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
        (differences.len() > 1).then(|| ((count - 1.0) / count * squares).sqrt())
    }

    /// Returns true if it is greater than another one by less than a multiple of the standard error
    /// of the difference.
    fn is_within(&self, multiple: f64, other: &Self) -> bool {
        let scatter = self.standard_error(&other.without);
        scatter.is_some_and(|scatter| self.all - other.all < multiple * scatter)
    }
}

/// Standard error of a mean error over its trials; `None` for fewer than two.
pub fn standard_error(weighed: &CandidateEvaluation) -> Option<f64> {
    let zeros = vec![0.0; weighed.each.len()];
    let relative = LogError::from_errors(&weighed.each).standard_error(&zeros)?;
    // The error of a logarithm is relative.
    Some(relative * weighed.error?)
}

/// Returns true if a candidate's error is not significantly greater than that of another on the same
/// trials (95 %, Student's quantile); false for a single trial, which has no scatter.
pub(crate) fn is_tied(one: &CandidateEvaluation, other: &CandidateEvaluation) -> bool {
    let [one, other] = [one, other].map(|one| LogError::from_errors(&one.each));
    one.is_within(student_quantile(other.without.len().max(2) - 1), &other)
}

/// Returns the place of the chosen candidate: of all within one standard error of the least error,
/// the one with the least sum of its error and a multiple ([`SEARCH`]`.elsewhere`) of its variance
/// where no trial reaches. `None` if every simulation diverged.
///
/// A law with more coefficients than the trials determine, and a prior too weak for them, do as
/// well on trials like the recorded ones; elsewhere they scatter. The rule of one standard error
/// (Breiman et al. 1984, Classification and regression trees, section 3.4.3) counts coefficients
/// instead of the variance, which is less informative where a prior determines them.
///
/// A candidate with a prior from a population (`true`) is preferred to all others unless the least
/// error is significantly less (95 %): where trials are statistically tied, other ships decide
/// (docs/evidence/population.md). A candidate that is tied only because its own error scatters is
/// replaced by one that is less in both error and sum.
pub fn choose_candidate(all: &[(&CandidateEvaluation, bool)]) -> Option<usize> {
    let (tried, held): (Vec<&CandidateEvaluation>, Vec<bool>) = all.iter().copied().unzip();
    let sails = |place: &usize| tried[*place].error.is_some_and(f64::is_finite);
    let sailed: Vec<usize> = (0..tried.len()).filter(sails).collect();
    let sailed = without_unsafe(&tried, sailed);
    // Errors are compared on the same trials, so that differences of jackknife values cancel what
    // trials have in common.
    let logs: Vec<LogError> = tried.iter().map(|one| LogError::from_errors(&one.each)).collect();
    let least = |a: &usize, b: &usize| logs[*a].all.total_cmp(&logs[*b].all);
    let best = sailed.iter().copied().min_by(least)?;
    let alike = |place: &usize| {
        // One standard error for most candidates; a population is tied up to the 95 % quantile of
        // Student's distribution.
        let within =
            if held[*place] { student_quantile(logs[best].without.len().max(2) - 1) } else { 1.0 };
        *place == best || logs[*place].is_within(within, &logs[best])
    };
    let anywhere = |place: &usize| {
        let variance = tried[*place].variance.unwrap_or(f64::INFINITY);
        logs[*place].all.exp() + SEARCH.elsewhere * variance
    };
    let by_population_first = |a: &usize, b: &usize| held[*b].cmp(&held[*a]);
    let first = |a: &usize, b: &usize| {
        by_population_first(a, b).then(anywhere(a).total_cmp(&anywhere(b))).then(least(a, b))
    };
    let taken = sailed.iter().copied().filter(alike).min_by(first)?;
    // A candidate with a large scatter is tied with much better ones; this corrects such a choice.
    let is_less_in_both = |place: &usize| {
        !held[taken] && least(place, &taken).is_lt() && anywhere(place) < anywhere(&taken)
    };
    sailed.into_iter().filter(is_less_in_both).min_by(first).or(Some(taken))
}

/// Leaves out candidates of whose folds a model does not complete the random rudder orders, so that
/// their variance elsewhere is not finite, if a fitted one does whose error is within a ratio
/// ([`SEARCH`]`.unsafe_ratio`) of the least.
fn without_unsafe(tried: &[&CandidateEvaluation], sailed: Vec<usize>) -> Vec<usize> {
    let error = |place: &usize| tried[*place].error.unwrap_or(f64::INFINITY);
    let is_safe = |place: &usize| tried[*place].variance.is_some_and(f64::is_finite);
    let is_fitted = |place: &usize| tried[*place].coefficients > 0;
    let least = sailed.iter().map(error).fold(f64::INFINITY, f64::min);
    let is_near = |place: &&usize| is_fitted(place) && error(place) <= SEARCH.unsafe_ratio * least;
    match sailed.iter().filter(is_near).any(is_safe) {
        true => sailed.into_iter().filter(is_safe).collect(),
        false => sailed,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn entry(coefficients: usize, errors: &[f64]) -> CandidateEvaluation {
        let each = errors.iter().enumerate().map(|(k, error)| (k.to_string(), *error)).collect();
        let error = Some(errors.iter().sum::<f64>() / errors.len() as f64);
        let variance = Some(0.01 * coefficients as f64);
        CandidateEvaluation {
            step: String::new(),
            error,
            shortest: error,
            each,
            variance,
            coefficients,
            effective: None,
            ridge: None,
            folds: Vec::new(),
            reason: None,
        }
    }

    fn choice(tried: &[CandidateEvaluation]) -> Option<usize> {
        choose_candidate(&tried.iter().map(|one| (one, false)).collect::<Vec<_>>())
    }

    #[test]
    fn of_what_is_not_told_apart_a_population_is_taken_first() {
        let steady = entry(0, &[1.0, 1.2, 0.9, 1.1]);
        let alike = entry(20, &[0.5, 1.5, 0.6, 1.4]);
        let better = entry(0, &[0.5, 0.7, 0.4, 0.6]);
        assert_eq!(choose_candidate(&[(&steady, false), (&alike, true)]), Some(1));
        assert_eq!(choose_candidate(&[(&better, false), (&steady, true)]), Some(0));
    }

    #[test]
    fn a_population_is_told_apart_by_more_than_one_standard_error() {
        let best = entry(0, &[1.0, 1.2, 0.9, 1.1]);
        let apart = entry(0, &[1.3, 1.2, 0.8, 1.5]);
        let differ = LogError::from_errors(&apart.each).all - LogError::from_errors(&best.each).all;
        let scatter = LogError::from_errors(&apart.each)
            .standard_error(&LogError::from_errors(&best.each).without);
        let times = differ / scatter.unwrap();
        assert!(times > 1.0 && times < student_quantile(3), "{times}");
        assert_eq!(choose_candidate(&[(&best, false), (&apart, false)]), Some(0));
        assert_eq!(choose_candidate(&[(&best, false), (&apart, true)]), Some(1));
        let far = entry(0, &[2.2, 2.4, 1.8, 2.1]);
        assert_eq!(choose_candidate(&[(&best, false), (&far, true)]), Some(0));
    }

    #[test]
    fn a_model_that_random_orders_stop_gives_way_to_one_of_nearly_its_error() {
        let of = |coefficients, error: f64, variance| CandidateEvaluation {
            variance,
            ..entry(coefficients, &[0.9 * error, 1.1 * error, error])
        };
        let (stops, near) = (of(180, 0.07, Some(f64::INFINITY)), of(21, 0.13, Some(0.07)));
        assert_eq!(choice(&[stops.clone(), near]), Some(1));
        assert_eq!(choice(&[stops.clone(), of(21, 0.7, Some(0.07))]), Some(0), "far off");
        assert_eq!(choice(&[stops, of(0, 0.13, Some(0.0))]), Some(0), "a source as it is");
    }

    #[test]
    fn of_what_is_not_told_apart_the_steadiest_is_taken() {
        let simple = entry(0, &[1.0, 1.2, 0.9, 1.1]);
        let alike = entry(20, &[0.5, 1.5, 0.6, 1.4]);
        let better = entry(20, &[0.5, 0.7, 0.4, 0.6]);
        assert_eq!(choice(&[simple.clone(), alike]), Some(0));
        assert_eq!(choice(&[simple, better]), Some(1));
        assert_eq!(choice(&[CandidateEvaluation { error: None, ..entry(0, &[1.0]) }]), None);
    }

    #[test]
    fn what_scatters_is_not_taken_before_what_is_less_in_error_and_variance() {
        let least = CandidateEvaluation { variance: None, ..entry(0, &[0.018, 0.021, 0.02]) };
        let scattered = entry(200, &[0.9, 0.001, 0.014]);
        let steady = entry(1, &[0.03, 0.033, 0.031]);
        assert_eq!(choice(&[least.clone(), scattered.clone()]), Some(1));
        assert_eq!(choice(&[least, scattered, steady]), Some(2));
    }

    #[test]
    fn standard_error_of_a_mean_of_like_errors_is_the_usual_one() {
        let errors = [1.00, 1.02, 0.97, 1.01, 1.00, 0.99];
        let mean = errors.iter().sum::<f64>() / 6.0;
        let usual = (errors.iter().map(|e: &f64| (e - mean).powi(2)).sum::<f64>() / 30.0).sqrt();
        assert!((standard_error(&entry(0, &errors)).unwrap() / usual - 1.0).abs() < 0.01);
    }
}
