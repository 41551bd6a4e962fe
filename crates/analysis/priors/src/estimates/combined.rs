//! Combination of several regressions for one value: a mixture, and its mean and covariance.
//!
//! Each regression gives a value with a scatter. The mixture weights them by the inverse of their
//! variances; its variance is the mean variance within the regressions and the variance between
//! them (law of total variance). The deviation of a regression is common to all of its values, so
//! that their covariance follows.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use crate::estimates::regression::RegressionValue;

/// Share of the mixture's variance that is used. The scatter of each regression against four hulls
/// includes its bias, which the variance between regressions counts again, and values of one ship
/// are not independent. Chosen so that the bands contain the values of ships of the zoo as often as
/// they should (docs/evidence/estimates.md).
pub const SPREAD: f64 = 0.35;

/// One value of the mixture.
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedEstimate {
    /// Name of the estimated value.
    pub name: String,
    /// Value of each regression.
    pub given: Vec<RegressionValue>,
    /// Mean.
    pub mean: f64,
    /// Variance within the regressions.
    pub within: f64,
}

impl CombinedEstimate {
    /// Combines the values of regressions; none where there is no value.
    pub fn from_regressions(name: &str, given: Vec<RegressionValue>) -> Option<Self> {
        let weights = inverse_variances(&given);
        let total: f64 = weights.iter().sum();
        if given.is_empty() || total <= 0.0 || total.is_nan() {
            return None;
        }
        // Weights are inverse variances, the mean is their weighted sum.
        let mean = given.iter().zip(&weights).map(|(one, w)| w * one.value).sum::<f64>() / total;
        let within =
            given.iter().zip(&weights).map(|(one, w)| w * one.scatter.powi(2)).sum::<f64>() / total;
        Some(Self { name: name.to_owned(), given, mean, within })
    }

    /// Regression with the largest weight.
    pub fn leading_regression(&self) -> Option<&RegressionValue> {
        self.given.iter().min_by(|a, b| a.scatter.total_cmp(&b.scatter))
    }

    /// Deviation of each regression from the mean, times the root of its weight.
    fn weighted_deviations(&self) -> BTreeMap<&str, f64> {
        let weights = inverse_variances(&self.given);
        let total: f64 = weights.iter().sum();
        let mut deviations = BTreeMap::new();
        for (given, weight) in self.given.iter().zip(&weights) {
            let deviation = (weight / total).sqrt() * (given.value - self.mean);
            deviations.insert(given.regression.as_str(), deviation);
        }
        deviations
    }
}

fn inverse_variances(given: &[RegressionValue]) -> Vec<f64> {
    // A floor of the scatter, so that a regression without any has a finite weight.
    given.iter().map(|one| one.scatter.max(1e-12).powi(-2)).collect()
}

/// Covariance of values, in their order.
pub fn mixture_covariance(values: &[CombinedEstimate]) -> DMatrix<f64> {
    let deviations: Vec<BTreeMap<&str, f64>> =
        values.iter().map(CombinedEstimate::weighted_deviations).collect();
    DMatrix::from_fn(values.len(), values.len(), |i, j| {
        // Only regressions that give both values contribute to the covariance between them.
        let between: f64 = deviations[i]
            .iter()
            .filter_map(|(name, a)| deviations[j].get(name).map(|b| a * b))
            .sum();
        SPREAD * (between + if i == j { values[i].within } else { 0.0 })
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn given(regression: &str, value: f64, scatter: f64) -> RegressionValue {
        RegressionValue { regression: regression.into(), value, scatter }
    }

    #[test]
    fn mean_and_variance_are_those_of_the_mixture() {
        let two = CombinedEstimate::from_regressions(
            "Y_v",
            vec![given("a", -0.3, 0.1), given("b", -0.2, 0.1)],
        )
        .unwrap();
        assert!((two.mean + 0.25).abs() < 1e-12);
        assert!((mixture_covariance(&[two])[(0, 0)] - SPREAD * (0.01 + 0.0025)).abs() < 1e-12);
        let sure = CombinedEstimate::from_regressions(
            "Y_v",
            vec![given("a", -0.3, 0.1), given("b", -0.2, 0.01)],
        )
        .unwrap();
        assert!(
            (sure.mean + 0.201).abs() < 1e-3
                && sure.leading_regression().unwrap().regression == "b"
        );
        assert_eq!(CombinedEstimate::from_regressions("Y_v", Vec::new()), None);
    }

    #[test]
    fn values_of_the_same_regressions_go_together() {
        let of = |name, a, b| {
            CombinedEstimate::from_regressions(name, vec![given("a", a, 0.1), given("b", b, 0.1)])
                .unwrap()
        };
        let pair = [of("Y_v", -0.3, -0.2), of("N_v", -0.12, -0.10)];
        let together = mixture_covariance(&pair);
        assert!((together[(0, 1)] - SPREAD * 0.05 * 0.01).abs() < 1e-12, "{together}");
        assert!(together.cholesky().is_some());
    }
}
