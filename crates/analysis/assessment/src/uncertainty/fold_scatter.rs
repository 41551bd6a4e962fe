//! Widening of a posterior by the scatter of its folds.
//!
//! A posterior by the noise of the readings alone presumes that the law is exact. Models that each
//! missed some of the trials differ by the errors of the law, too: their scatter is the jackknife's
//! estimate of a figure's variance, `(g - 1) / g sum (f_i - mean f)^2` over `g` folds (Efron and
//! Tibshirani 1993, An introduction to the bootstrap, Eq. 11.5), which is compared with that of the
//! posterior. Few folds estimate the variance of one figure badly; the mean over the figures of all
//! standard manoeuvres is better, the more so the less these depend on each other.

use sistership_model::Model;
use sistership_model::law::Law;

use crate::uncertainty::bands::figures_by_name;
use crate::uncertainty::next_trial::DrawFigures;
use crate::uncertainty::sampling::{Sampling, draw_from_posterior};

/// Draws that estimate the posterior's own scatter.
const DRAWS: usize = 40;

/// Quantile of 97.5 % of the normal distribution.
const NORMAL: f64 = 1.959_964;

/// Returns the root of the ratio of the jackknife's variance to the posterior's, in the mean over
/// the figures of the standard manoeuvres. At least 1, and 1 if fewer than three folds complete the
/// manoeuvres. The variance is a mean over some twenty figures, so that bands need no Student's
/// quantile: with it, bands of six trials contain 100 % of the true figures instead of 95 %
/// (docs/evidence/plain.md).
pub fn fold_factor(model: &Model, law: &Law, folds: &[Model]) -> f64 {
    let sampling = Sampling { samples: DRAWS, ..Sampling::default() };
    let of = |models: &[Model]| figures_by_name(model, law, models);
    let drawn = draw_from_posterior(model, sampling).and_then(|draws| of(&draws));
    let left_out = of(folds).filter(|left_out| left_out.len() > 2);
    let (Some(drawn), Some(left_out)) = (drawn, left_out) else { return 1.0 };
    let ratios: Vec<f64> = left_out[0]
        .keys()
        // The IMO criteria repeat other figures.
        .filter(|name| !name.starts_with("IMO"))
        .filter_map(|name| {
            let count = left_out.len() as f64;
            // Sum of squares about the folds' mean, times `(g - 1)/g`.
            let jackknife = (count - 1.0) / count * sum_of_squares(&left_out, name)?;
            let own = sum_of_squares(&drawn, name)? / drawn.len() as f64;
            (own > 0.0).then(|| jackknife / own)
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
    mean.sqrt().max(1.0)
}

/// Returns Student's quantile of 97.5 % for some degrees of freedom (Abramowitz and Stegun 1964,
/// Handbook of mathematical functions, Eq. 26.7.5, two terms: 10 % low for two degrees, 4 % for
/// three, 1 % for five).
pub fn student_quantile(degrees: usize) -> f64 {
    let (x, degrees) = (NORMAL, degrees as f64);
    let first = (x.powi(3) + x) / 4.0;
    let second = (5.0 * x.powi(5) + 16.0 * x.powi(3) + 3.0 * x) / 96.0;
    x + first / degrees + second / degrees.powi(2)
}

/// Sum of squares about the mean; `None` if not all reach the figure.
fn sum_of_squares(figures: &[DrawFigures], name: &str) -> Option<f64> {
    let values: Vec<f64> =
        figures.iter().map(|one| one.get(name).copied()).collect::<Option<_>>()?;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    Some(values.iter().map(|value| (value - mean).powi(2)).sum())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;
    use sistership_model::posterior::Posterior;

    use super::*;

    /// Folds whose rudder coefficients lie so many deviations to either side.
    fn factor(apart: f64) -> f64 {
        let zoo = Zoo::load_embedded().unwrap();
        let mut model = zoo.find_model("mariner").unwrap();
        let names = vec!["N_delta".to_owned()];
        let value = model.coefficient("N_delta");
        let deviations = vec![0.02 * value.abs()];
        let root_correlation = Posterior::format_rows(1, &|_, _| 1.0);
        let values = vec![value];
        model.posterior = Some(Posterior { names, values, deviations, root_correlation });
        let fold = |side: f64| {
            let mut fold = Model { posterior: None, ..model.clone() };
            let by = 1.0 + 0.02 * apart * side;
            fold.coefficients.get_mut("N_delta").unwrap().value *= by;
            fold
        };
        let law = zoo.law("abkowitz").unwrap();
        fold_factor(&model, law, &[-1.0, -1.0, 1.0, 1.0].map(fold))
    }

    #[test]
    fn folds_that_lie_wider_than_the_posterior_widen_it() {
        // Of four folds at one deviation, the jackknife's variance is three times the posterior's.
        let (expected, once) = (3.0_f64.sqrt(), factor(1.0));
        assert!((once / expected - 1.0).abs() < 0.25, "{once} by {expected}");
        assert!((factor(2.0) / once - 2.0).abs() < 0.1);
        assert_eq!(factor(0.1), 1.0);
    }

    #[test]
    fn students_quantile_is_the_tables() {
        for (degrees, table) in [(3, 3.182), (5, 2.571), (10, 2.228), (30, 2.042)] {
            assert!((student_quantile(degrees) / table - 1.0).abs() < 0.04, "{degrees}");
        }
    }
}
