//! The evidence for hypotheses: how much more probable they make the readings than the model alone
//! does.
//!
//! The coefficients are left the slack of their prior and integrated out, and so are the parameters
//! of an effect under theirs: the logarithm of the likelihood ratio that remains has paid for every
//! parameter (Kass and Raftery 1995, J Am Stat Assoc 90, 773-795). The autocorrelation of what no
//! coefficient explains is in the filter's discrepancy.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::coefficient_prior::CoefficientPrior;
use super::discount::is_from_outside;
use sistership_filtering::{EffectCandidate, Gram};
use sistership_identification::refine::RefineError;

/// The columns of effects with the coefficients integrated out.
#[derive(Debug, Clone)]
pub struct MarginalInformation {
    /// Minus twice the logarithm of the likelihood of the model without any effect, less a
    /// constant.
    pub deviance: f64,
    /// Information of the effects' columns.
    pub information: DMatrix<f64>,
    /// Their products with what remains of the residual.
    pub right: DVector<f64>,
    /// `A^-1 G_ce` and `A^-1 b_c`: how the coefficients answer to the effects.
    pub answers: DMatrix<f64>,
    /// The change of the coefficients without any effect.
    pub shift: DVector<f64>,
}

/// A normal prior of one column, as a distance from where the column is a tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPrior {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// What a hypothesis gives.
#[derive(Debug, Clone)]
pub struct HypothesisEstimate {
    /// Logarithm of how much more probable the readings are than under the model alone.
    pub gain: f64,
    /// The parameters, as distances from where the columns are tangents.
    pub mean: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

/// The level of the discrepancy, as a factor on what is expected of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscrepancyFactor {
    /// The factor.
    pub factor: f64,
    /// Logarithm of its prior probability.
    pub log_prior: f64,
}

impl DiscrepancyFactor {
    /// Whether it is weighed for an effect, or for the model alone: a level below what calibration
    /// saw is for what was there on its trials, too.
    pub fn is_weighed(self, of: Option<&EffectCandidate>) -> bool {
        self.factor >= 1.0 || of.is_some_and(is_from_outside)
    }
}

impl MarginalInformation {
    /// Integrates the first `coefficients` columns out.
    ///
    /// # Errors
    /// Says that the information on the coefficients is not positive.
    pub fn new(gram: &Gram, fixed: &CoefficientPrior) -> Result<Self, RefineError> {
        let c = fixed.weighted_mean.len();
        let e = gram.products.nrows() - 1 - c;
        let products = &gram.products;
        let own = products.view((1, 1), (c, c)) + &fixed.information;
        let cross = products.view((1, 1 + c), (c, e)).into_owned();
        let right = products.view((1, 0), (c, 1)).column(0) + &fixed.weighted_mean;
        let coefficients = Cholesky::new(own).ok_or_else(not_positive)?;
        let answers = coefficients.solve(&cross);
        let shift = coefficients.solve(&right);
        let information = products.view((1 + c, 1 + c), (e, e)) - cross.transpose() * &answers;
        let remaining = products.view((1 + c, 0), (e, 1)).column(0) - cross.transpose() * &shift;
        let log_determinant: f64 =
            2.0 * coefficients.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let deviance = products[(0, 0)] + gram.log_variance - right.dot(&shift) + log_determinant;
        Ok(Self { deviance, information, right: remaining, answers, shift })
    }

    /// Some of the effects' columns, with others integrated out under their priors.
    pub fn given(
        &self,
        others: &[usize],
        priors: &[NormalPrior],
        columns: &[usize],
    ) -> Option<Self> {
        let (own, right) = self.posterior(others, priors);
        let cross = DMatrix::from_fn(others.len(), columns.len(), |i, j| {
            self.information[(others[i], columns[j])]
        });
        let factor = Cholesky::new(own)?;
        let part = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            self.information[(columns[i], columns[j])]
        });
        let remaining = DVector::from_fn(columns.len(), |i, _| self.right[columns[i]]);
        Some(Self {
            information: part - cross.transpose() * factor.solve(&cross),
            right: remaining - cross.transpose() * factor.solve(&right),
            ..self.clone()
        })
    }

    /// What other trials say of the same columns besides.
    pub fn plus(mut self, other: Self) -> Self {
        self.information += other.information;
        self.right += other.right;
        self.deviance += other.deviance;
        self
    }

    /// Logarithm of the likelihood at a distance from where the columns are tangents, by that at no
    /// distance.
    pub fn at(&self, distance: &DVector<f64>) -> f64 {
        self.right.dot(distance) - 0.5 * distance.dot(&(&self.information * distance))
    }

    /// As if the trials said less by a factor.
    pub fn discounted(mut self, by: f64) -> Self {
        self.information /= by;
        self.right /= by;
        self
    }

    /// The columns that are sums of these by a matrix, these by those.
    pub fn through(&self, sums: &DMatrix<f64>) -> Self {
        Self {
            information: sums.tr_mul(&(&self.information * sums)),
            right: sums.tr_mul(&self.right),
            ..self.clone()
        }
    }

    /// Some of the columns alone.
    pub fn of_columns(&self, columns: &[usize]) -> Self {
        let size = columns.len();
        let one = |i: usize, j: usize| self.information[(columns[i], columns[j])];
        Self {
            information: DMatrix::from_fn(size, size, one),
            right: DVector::from_fn(size, |i, _| self.right[columns[i]]),
            ..self.clone()
        }
    }

    /// What some columns explain (in squared deviations), and what chance lets them explain: of a
    /// right model without an effect, the first is a chi-square whose mean is the second.
    pub fn explained(&self, columns: &[usize], priors: &[NormalPrior]) -> Option<(f64, f64)> {
        let free: Vec<NormalPrior> =
            priors.iter().map(|prior| NormalPrior { mean: 0.0, ..*prior }).collect();
        let (posterior, right) = self.posterior(columns, &free);
        let factor = Cholesky::new(posterior)?;
        let left: f64 = (0..columns.len())
            .map(|i| factor.inverse()[(i, i)] * priors[i].deviation.powi(-2))
            .sum();
        Some((right.dot(&factor.solve(&right)), columns.len() as f64 - left))
    }

    /// Information and right side of some columns with their priors.
    fn posterior(&self, columns: &[usize], priors: &[NormalPrior]) -> (DMatrix<f64>, DVector<f64>) {
        let size = columns.len();
        let precision = |i: usize| priors[i].deviation.powi(-2);
        let mut information =
            DMatrix::from_fn(size, size, |i, j| self.information[(columns[i], columns[j])]);
        let mut right = DVector::from_fn(size, |i, _| self.right[columns[i]]);
        for i in 0..size {
            information[(i, i)] += precision(i);
            right[i] += precision(i) * priors[i].mean;
        }
        (information, right)
    }

    /// The estimate of a hypothesis that has some of the effects' columns, with their priors.
    pub fn estimate(
        &self,
        columns: &[usize],
        priors: &[NormalPrior],
    ) -> Option<HypothesisEstimate> {
        let (information, right) = self.posterior(columns, priors);
        let of = |fixing: &NormalPrior| {
            (fixing.mean / fixing.deviation).powi(2) + 2.0 * fixing.deviation.ln()
        };
        let prior: f64 = priors.iter().map(of).sum();
        let factor = Cholesky::new(information)?;
        let mean = factor.solve(&right);
        let log_determinant: f64 =
            2.0 * factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        Some(HypothesisEstimate {
            gain: 0.5 * (right.dot(&mean) - prior - log_determinant),
            mean,
            covariance: factor.inverse(),
        })
    }
}

/// The refusal where information has no root.
pub(super) fn not_positive() -> RefineError {
    RefineError::Data("the trials' information is not positive".into())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// One coefficient and one effect: what is left of the effect is its Schur complement, and
    /// information that is not positive is an error, not an absence of evidence.
    #[test]
    fn coefficients_are_integrated_out_or_the_reason_is_told() {
        let mut gram = Gram::empty(3);
        gram.products =
            DMatrix::from_row_slice(3, 3, &[9.0, 2.0, 1.0, 2.0, 4.0, 3.0, 1.0, 3.0, 5.0]);
        let fixed = CoefficientPrior {
            information: DMatrix::from_element(1, 1, 1.0),
            weighted_mean: DVector::from_element(1, 0.5),
        };
        let reduced = MarginalInformation::new(&gram, &fixed).unwrap();
        assert!((reduced.information[(0, 0)] - (5.0 - 9.0 / 5.0)).abs() < 1e-12);
        assert!((reduced.right[0] - (1.0 - 3.0 * 2.5 / 5.0)).abs() < 1e-12);
        assert!((reduced.deviance - (9.0 - 2.5 * 2.5 / 5.0 + 5.0_f64.ln())).abs() < 1e-12);
        gram.products[(1, 1)] = -2.0;
        let refusal = MarginalInformation::new(&gram, &fixed).unwrap_err().to_string();
        assert!(refusal.contains("information is not positive"), "{refusal}");
    }
}
