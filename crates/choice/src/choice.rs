//! The choice among what was tried, by errors on the same trials left out.
//!
//! What is compared is the logarithm of the mean error, whose differences are ratios of errors. Its
//! scatter over the trials is told by the jackknife (Efron and Tibshirani 1993, An introduction to
//! the bootstrap, Eq. 11.5).

use std::collections::BTreeMap;

use sistership_estimate::refine::Weighed;

/// Below this an error is no error: the logarithm of less would decide alone.
const LEAST: f64 = 1e-9;

/// The logarithm of a mean error, and the same with each trial left out.
struct LogError {
    all: f64,
    without: Vec<f64>,
}

impl LogError {
    fn of(each: &BTreeMap<String, f64>) -> Self {
        let (sum, count) = (each.values().sum::<f64>(), each.len() as f64);
        let without = |error: &f64| ((sum - error).max(0.0) / (count - 1.0)).max(LEAST).ln();
        Self { all: (sum / count).max(LEAST).ln(), without: each.values().map(without).collect() }
    }

    /// Standard error of the difference to another; none where a single trial tells nothing of it.
    fn standard_error(&self, other: &[f64]) -> Option<f64> {
        let differences: Vec<f64> =
            self.without.iter().zip(other).map(|(one, other)| one - other).collect();
        let count = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / count;
        let squares = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
        (differences.len() > 1).then(|| ((count - 1.0) / count * squares).sqrt())
    }
}

/// Standard error of a mean error over its trials; none below two.
pub fn standard_error(weighed: &Weighed) -> Option<f64> {
    let zeros = vec![0.0; weighed.each.len()];
    let relative = LogError::of(&weighed.each).standard_error(&zeros)?;
    Some(relative * weighed.error?)
}

/// What was weighed, and whether a source holds it where no trial reaches.
pub type Candidate<'a> = (&'a Weighed, bool);

/// The place of what is taken: of all that is within one standard error of the least error, one
/// with a source before one without, then that with the fewest coefficients fitted, and among
/// equals the lesser error (Breiman et al. 1984, Classification and regression trees, section
/// 3.4.3). Without a source nothing holds a model between and beyond the trials, which errors on
/// trials left out do not tell (docs/evidence/plain.md). `None` where every simulation diverged.
pub fn chosen(tried: &[Candidate<'_>]) -> Option<usize> {
    let sails = |place: &usize| tried[*place].0.error.is_some_and(f64::is_finite);
    let sailed: Vec<usize> = (0..tried.len()).filter(sails).collect();
    let logs: Vec<LogError> = tried.iter().map(|one| LogError::of(&one.0.each)).collect();
    let least = |a: &usize, b: &usize| logs[*a].all.total_cmp(&logs[*b].all);
    let best = sailed.iter().copied().min_by(least)?;
    let alike = |place: &usize| {
        let scatter = logs[*place].standard_error(&logs[best].without);
        *place == best || scatter.is_some_and(|scatter| logs[*place].all - logs[best].all < scatter)
    };
    let rank = |place: &usize| (!tried[*place].1, tried[*place].0.coefficients);
    let alike = sailed.iter().copied().filter(alike);
    alike.min_by(|a, b| rank(a).cmp(&rank(b)).then(least(a, b)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn entry(coefficients: usize, errors: &[f64]) -> Weighed {
        let each = errors.iter().enumerate().map(|(k, error)| (k.to_string(), *error)).collect();
        let error = Some(errors.iter().sum::<f64>() / errors.len() as f64);
        Weighed { step: String::new(), error, each, coefficients, ridge: None, reason: None }
    }

    fn choice(tried: &[Weighed]) -> Option<usize> {
        chosen(&tried.iter().map(|one| (one, true)).collect::<Vec<_>>())
    }

    #[test]
    fn of_what_is_alike_a_source_is_kept() {
        let (small, large) = (entry(10, &[1.0, 1.2, 0.9, 1.1]), entry(20, &[1.1, 1.1, 1.0, 0.9]));
        assert_eq!(chosen(&[(&small, false), (&large, true)]), Some(1));
        let better = entry(30, &[0.5, 0.6, 0.4, 0.5]);
        assert_eq!(chosen(&[(&better, false), (&large, true)]), Some(0));
    }

    #[test]
    fn what_is_not_told_apart_stays_simple() {
        let simple = entry(0, &[1.0, 1.2, 0.9, 1.1]);
        let alike = entry(20, &[0.5, 1.5, 0.6, 1.4]);
        let better = entry(20, &[0.5, 0.7, 0.4, 0.6]);
        assert_eq!(choice(&[simple.clone(), alike]), Some(0));
        assert_eq!(choice(&[simple, better]), Some(1));
        assert_eq!(choice(&[Weighed { error: None, ..entry(0, &[1.0]) }]), None);
    }

    #[test]
    fn standard_error_of_a_mean_of_like_errors_is_the_usual_one() {
        let errors = [1.00, 1.02, 0.97, 1.01, 1.00, 0.99];
        let mean = errors.iter().sum::<f64>() / 6.0;
        let usual = (errors.iter().map(|e: &f64| (e - mean).powi(2)).sum::<f64>() / 30.0).sqrt();
        assert!((standard_error(&entry(0, &errors)).unwrap() / usual - 1.0).abs() < 0.01);
    }
}
