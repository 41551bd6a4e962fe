//! The choice among entrants by paired differences on trials left out.

use std::collections::BTreeMap;

use crate::refine::Weighed;

/// By how many standard errors a more complex entrant must win among `count`.
///
/// Of K independent Gaussian errors of deviation s the largest is expected to be at most `s sqrt(2 ln K)`: with M their maximum,
/// `exp(t E[M]) <= E[exp(t M)] <= K exp(t^2 s^2 / 2)` for every t > 0 (Jensen), and `t = sqrt(2 ln K) / s` gives the bound
/// (Boucheron, Lugosi, Massart 2013, Concentration inequalities, Theorem 2.5). An entrant that gains no more may
/// do so by the number of them alone. Never less than the one standard error of Breiman et al. 1984, section 3.4.3.
pub fn factor(count: usize) -> f64 {
    (2.0 * (count.max(1) as f64).ln()).sqrt().max(1.0)
}

/// Below this an error is no error: the logarithm of less would decide alone.
const LEAST: f64 = 1e-9;

/// Mean of paired log ratios (`ln old - ln new`) over the trials that both have, and its standard
/// error; none below two. Squared errors of trials differ by decades, and what is won in one is in
/// proportion to it, so that their logarithms, not they themselves, scatter alike.
fn gain(old: &BTreeMap<String, f64>, new: &BTreeMap<String, f64>) -> Option<(f64, f64)> {
    let ratio =
        |(name, error): (&String, &f64)| Some((error.max(LEAST) / new.get(name)?.max(LEAST)).ln());
    let gains: Vec<f64> = old.iter().filter_map(ratio).collect();
    Some((gains.iter().sum::<f64>() / gains.len() as f64, of_mean(&gains)?))
}

/// Standard error of the mean of some values; none below two.
fn of_mean(values: &[f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    (values.len() > 1).then(|| (squares / (count - 1.0) / count).sqrt())
}

/// Standard error of an entrant's error over its trials.
pub fn standard_error(weighed: &Weighed) -> Option<f64> {
    of_mean(&weighed.each.values().copied().collect::<Vec<_>>())
}

/// The place of the entrant that is taken: from the fewest coefficients fitted outwards, a more complex one must win by more
/// than [`factor`] standard errors of the paired difference; among equals in complexity the lesser error leads. `None` where
/// every simulation diverged.
pub fn chosen(weighed: &[Weighed]) -> Option<usize> {
    let error = |place: &usize| weighed[*place].error.unwrap_or(f64::INFINITY);
    let mut order: Vec<usize> =
        (0..weighed.len()).filter(|place| error(place).is_finite()).collect();
    order.sort_by(|a, b| {
        let size = |place: &usize| weighed[*place].coefficients;
        size(a).cmp(&size(b)).then(error(a).total_cmp(&error(b)))
    });
    let factor = factor(order.len());
    let wins = |new: usize, old: usize| {
        gain(&weighed[old].each, &weighed[new].each).is_some_and(|(mean, se)| mean > factor * se)
    };
    order.into_iter().reduce(|best, next| if wins(next, best) { next } else { best })
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
        Weighed { step: String::new(), error, each, coefficients, reason: None }
    }

    #[test]
    fn what_is_not_told_apart_stays_simple() {
        let simple = entry(0, &[1.0, 1.2, 0.9, 1.1]);
        let alike = entry(20, &[0.5, 1.5, 0.6, 1.4]);
        let better = entry(20, &[0.5, 0.7, 0.4, 0.6]);
        assert_eq!(chosen(&[simple.clone(), alike]), Some(0));
        assert_eq!(chosen(&[simple, better]), Some(1));
        assert_eq!(chosen(&[Weighed { error: None, ..entry(0, &[1.0]) }]), None);
    }

    #[test]
    fn two_hundred_that_are_no_better_do_not_raise_the_error() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let (truth, noise) = (Normal::new(1.3, 0.1).unwrap(), Normal::new(0.0, 0.3).unwrap());
        let (ships, mut lost) = (50, 0.0);
        for _ in 0..ships {
            let mut trial = |mean: f64, size| {
                let errors: Vec<f64> = (0..8).map(|_| mean + noise.sample(&mut random)).collect();
                entry(size, &errors)
            };
            let mut all = vec![trial(1.0, 0)];
            let mut means = vec![1.0];
            for _ in 0..200 {
                let mean =
                    truth.sample(&mut rand_chacha::ChaCha8Rng::seed_from_u64(means.len() as u64));
                all.push(trial(mean, 10));
                means.push(mean);
            }
            lost += means[chosen(&all).unwrap()] - 1.0;
        }
        assert!(lost / f64::from(ships) < 0.03, "{}", lost / f64::from(ships));
    }
}
