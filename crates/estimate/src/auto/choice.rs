//! The choice among what was tried, by errors on the same trials left out.
//!
//! What is compared is the logarithm of the mean error, whose differences are ratios of errors. Its
//! scatter over the trials is told by the jackknife (Efron and Tibshirani 1993, An introduction to
//! the bootstrap, Eq. 11.5).

use std::collections::BTreeMap;

use super::ladder::Rung;
use crate::refine::Weighed;

/// Below this an error is no error: the logarithm of less would decide alone.
const LEAST: f64 = 1e-9;
/// Fewer than these tell nothing of how errors spread, a count. Source: derived: a median of absolute
/// deviations of three is the smaller of two.
const SPREAD: usize = 4;

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

/// The place of what is taken: of all that is within one standard error of the least error, that with
/// the fewest coefficients fitted, and among equals the lesser error (Breiman et al. 1984,
/// Classification and regression trees, section 3.4.3). Errors are first drawn towards those of
/// their rung, so that the luckiest of many alike does not lead by luck ([`drawn`]). `None` where
/// every simulation diverged.
pub fn chosen(tried: &[(Rung, &Weighed)]) -> Option<usize> {
    let sails = |place: &usize| tried[*place].1.error.is_some_and(f64::is_finite);
    let sailed: Vec<usize> = (0..tried.len()).filter(sails).collect();
    let logs: Vec<LogError> =
        tried.iter().map(|(_, weighed)| LogError::of(&weighed.each)).collect();
    let errors = all_drawn(tried, &sailed, &logs);
    let least = |a: &usize, b: &usize| errors[a].total_cmp(&errors[b]);
    let best = sailed.iter().copied().min_by(least)?;
    let alike = |place: &usize| {
        let scatter = logs[*place].standard_error(&logs[best].without);
        *place == best || scatter.is_some_and(|scatter| errors[place] - errors[&best] < scatter)
    };
    let size = |place: &usize| tried[*place].1.coefficients;
    let alike = sailed.iter().copied().filter(alike);
    alike.min_by(|a, b| size(a).cmp(&size(b)).then(least(a, b)))
}

/// Every error drawn towards those of its rung.
fn all_drawn(
    tried: &[(Rung, &Weighed)],
    sailed: &[usize],
    logs: &[LogError],
) -> BTreeMap<usize, f64> {
    let mut errors = BTreeMap::new();
    for rung in Rung::ALL {
        let places: Vec<usize> =
            sailed.iter().copied().filter(|place| tried[*place].0 == rung).collect();
        let group: Vec<&LogError> = places.iter().map(|place| &logs[*place]).collect();
        errors.extend(places.iter().copied().zip(drawn(&group)));
    }
    errors
}

/// Errors of a group, each drawn towards the group's median by the share of its scatter in what is
/// seen (empirical Bayes; Efron and Morris 1975, J Am Stat Assoc 70, 311-319, Eqs. 2.4-2.6): where
/// they differ by more than chance, hardly at all. The spread is robust: 1.4826 times the median of
/// absolute deviations, as of a normal distribution.
fn drawn(group: &[&LogError]) -> Vec<f64> {
    let all: Vec<f64> = group.iter().map(|log| log.all).collect();
    if group.len() < SPREAD {
        return all;
    }
    let centre = median(all.clone());
    let trials = group[0].without.len();
    let without: Vec<f64> = (0..trials)
        .map(|trial| median(group.iter().map(|log| log.without[trial]).collect()))
        .collect();
    let scatters: Vec<f64> = group
        .iter()
        .map(|log| log.standard_error(&without).unwrap_or(f64::INFINITY).powi(2))
        .collect();
    let seen = 1.4826 * median(all.iter().map(|error| (error - centre).abs()).collect());
    let true_spread = (seen.powi(2) - median(scatters.clone())).max(0.0);
    let draw = |(error, scatter): (&f64, &f64)| {
        let kept = if true_spread > 0.0 { true_spread / (true_spread + scatter) } else { 0.0 };
        centre + kept * (error - centre)
    };
    all.iter().zip(&scatters).map(draw).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len().is_multiple_of(2) {
        0.5 * (values[middle - 1] + values[middle])
    } else {
        values[middle]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    fn entry(coefficients: usize, errors: &[f64]) -> Weighed {
        let each = errors.iter().enumerate().map(|(k, error)| (k.to_string(), *error)).collect();
        let error = Some(errors.iter().sum::<f64>() / errors.len() as f64);
        Weighed { step: String::new(), error, each, coefficients, ridge: None, reason: None }
    }

    fn choice(tried: &[Weighed]) -> Option<usize> {
        chosen(&tried.iter().map(|weighed| (Rung::Weak, weighed)).collect::<Vec<_>>())
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

    /// Trials are hard or easy for all alike; besides, each error is off by 30 % on each trial. Of 200
    /// that are truly worse by 30 %, the luckiest looks better than the one that is best.
    #[test]
    fn two_hundred_that_are_worse_raise_the_error_little() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let (worse, noise) = (Normal::new(0.26, 0.05).unwrap(), Normal::new(0.0, 0.3).unwrap());
        let (ships, mut lost) = (50, 0.0);
        for _ in 0..ships {
            let hard: Vec<f64> = (0..8).map(|_| 2.0 * noise.sample(&mut random)).collect();
            let mut tried = |mean: f64, size, random: &mut rand_chacha::ChaCha8Rng| {
                let of = |hard: &f64| (mean + hard + noise.sample(random)).exp();
                entry(size, &hard.iter().map(of).collect::<Vec<_>>())
            };
            let mut means = vec![0.0];
            means.extend((0..200).map(|_| worse.sample(&mut random)));
            let all: Vec<Weighed> =
                means.iter().map(|mean| tried(*mean, 10, &mut random)).collect();
            lost += means[choice(&all).unwrap()].exp() - 1.0;
        }
        println!("{:.3}", lost / f64::from(ships));
        assert!(lost / f64::from(ships) < 0.10, "{}", lost / f64::from(ships));
    }
}
