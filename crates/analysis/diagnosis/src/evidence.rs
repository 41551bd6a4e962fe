//! Evidence for hypotheses: the ratio of the probability of the readings to that under the model
//! alone.
//!
//! The coefficients vary within their prior and are integrated out, and so are the parameters of an
//! effect within theirs: the logarithm of the likelihood ratio that remains includes the cost of
//! every parameter (Kass and Raftery 1995, J Am Stat Assoc 90, 773-795). The autocorrelation of the
//! unexplained accelerations is in the filter's discrepancy.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::coefficient_prior::CoefficientPrior;
use super::discount::is_external;
use sistership_filtering::{EffectCandidate, GramMatrix};
use sistership_identification::refine::RefineError;

/// Information on the columns of effects with the coefficients integrated out.
#[derive(Debug, Clone)]
pub struct MarginalInformation {
    /// Minus twice the logarithm of the likelihood of the model without any effect, less a
    /// constant.
    pub deviance: f64,
    /// Information of the effects' columns.
    pub information: DMatrix<f64>,
    /// Products of the columns with the remaining residual.
    pub right: DVector<f64>,
    /// `A^-1 G_ce` and `A^-1 b_c`: response of the coefficients to the effects.
    pub answers: DMatrix<f64>,
    /// Change of the coefficients without any effect.
    pub shift: DVector<f64>,
}

/// Normal prior of one column, as a distance from the point at which the column is a tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPrior {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// Estimate of a hypothesis.
#[derive(Debug, Clone)]
pub struct HypothesisEstimate {
    /// Logarithm of the ratio of the probability of the readings to that under the model alone.
    pub gain: f64,
    /// Parameters, as distances from the point at which the columns are tangents.
    pub mean: DVector<f64>,
    /// Covariance of the parameters.
    pub covariance: DMatrix<f64>,
}

/// Level of the discrepancy, as a factor on its expected value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscrepancyFactor {
    /// The factor.
    pub factor: f64,
    /// Logarithm of its prior probability.
    pub log_prior: f64,
}

impl DiscrepancyFactor {
    /// Returns true if the level is considered for an effect, or for the model alone: a level below
    /// that of the calibration applies only to influences that were also present on its trials.
    pub fn is_weighed(self, of: Option<&EffectCandidate>) -> bool {
        self.factor >= 1.0 || of.is_some_and(is_external)
    }
}

impl MarginalInformation {
    /// Integrates the first `coefficients` columns out.
    ///
    /// # Errors
    /// Returns an error if the information on the coefficients is not positive.
    pub fn new(gram: &GramMatrix, fixed: &CoefficientPrior) -> Result<Self, RefineError> {
        let c = fixed.weighted_mean.len();
        let e = gram.products.nrows() - 1 - c;
        let products = &gram.products;
        // With A the information on the coefficients: the Schur complement G_ee - G_ce' A^-1 G_ce.
        let own = products.view((1, 1), (c, c)) + &fixed.information;
        let cross = products.view((1, 1 + c), (c, e)).into_owned();
        let right = products.view((1, 0), (c, 1)).column(0) + &fixed.weighted_mean;
        let coefficients = Cholesky::new(own).ok_or_else(not_positive_error)?;
        let answers = coefficients.solve(&cross);
        let shift = coefficients.solve(&right);
        let information = products.view((1 + c, 1 + c), (e, e)) - cross.transpose() * &answers;
        let remaining = products.view((1 + c, 0), (e, 1)).column(0) - cross.transpose() * &shift;
        // Only the diagonal of the factor is needed, which `l_dirty` gives without a copy.
        let log_determinant: f64 =
            2.0 * coefficients.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let deviance = products[(0, 0)] + gram.log_variance - right.dot(&shift) + log_determinant;
        Ok(Self { deviance, information, right: remaining, answers, shift })
    }

    /// Selects some of the effects' columns, with others integrated out under their priors.
    pub fn marginalise_others(
        &self,
        others: &[usize],
        priors: &[NormalPrior],
        columns: &[usize],
    ) -> Option<Self> {
        let (own, right) = self.posterior_terms(others, priors);
        let cross = DMatrix::from_fn(others.len(), columns.len(), |i, j| {
            self.information[(others[i], columns[j])]
        });
        // Schur complement of the others: G_oo - G_ao' (G_aa + P)^-1 G_ao.
        let factor = Cholesky::new(own)?;
        let part = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            self.information[(columns[i], columns[j])]
        });
        let remaining = DVector::from_fn(columns.len(), |i, _| self.right[columns[i]]);
        Some(Self {
            information: part - cross.transpose() * factor.solve(&cross),
            right: remaining - cross.transpose() * factor.solve(&right),
            ..self.without_columns()
        })
    }

    /// Adds the information of other trials on the same columns.
    pub fn add_information(mut self, other: Self) -> Self {
        self.information += other.information;
        self.right += other.right;
        self.deviance += other.deviance;
        self
    }

    /// Logarithm of the likelihood at a distance from the point at which the columns are tangents,
    /// relative to that at no distance.
    pub fn log_likelihood_at(&self, distance: &DVector<f64>) -> f64 {
        self.right.dot(distance) - 0.5 * distance.dot(&(&self.information * distance))
    }

    /// Divides the information by a factor.
    pub fn divide_by(mut self, by: f64) -> Self {
        self.information /= by;
        self.right /= by;
        self
    }

    /// Transforms the information to columns that are sums of these by a matrix (old columns by new
    /// ones).
    pub fn transform_columns(&self, sums: &DMatrix<f64>) -> Self {
        Self {
            information: sums.tr_mul(&(&self.information * sums)),
            right: sums.tr_mul(&self.right),
            ..self.without_columns()
        }
    }

    /// Selects some of the columns, the others at zero.
    pub fn select_columns(&self, columns: &[usize]) -> Self {
        let size = columns.len();
        let one = |i: usize, j: usize| self.information[(columns[i], columns[j])];
        Self {
            information: DMatrix::from_fn(size, size, one),
            right: DVector::from_fn(size, |i, _| self.right[columns[i]]),
            ..self.without_columns()
        }
    }

    /// The same information without any column of an effect.
    fn without_columns(&self) -> Self {
        Self {
            deviance: self.deviance,
            information: DMatrix::zeros(0, 0),
            right: DVector::zeros(0),
            answers: DMatrix::zeros(self.answers.nrows(), 0),
            shift: self.shift.clone(),
        }
    }

    /// Improvement by some columns (in squared deviations), and its expected value by chance: for a
    /// right model without an effect, the first is a chi-square whose mean is the second.
    pub fn explained_and_chance(
        &self,
        columns: &[usize],
        priors: &[NormalPrior],
    ) -> Option<(f64, f64)> {
        let free: Vec<NormalPrior> =
            priors.iter().map(|prior| NormalPrior { mean: 0.0, ..*prior }).collect();
        let (posterior, right) = self.posterior_terms(columns, &free);
        let factor = Cholesky::new(posterior)?;
        // The prior holds part of each parameter: n - tr(S P) degrees of freedom are left.
        let left: f64 = (0..columns.len())
            .map(|i| factor.inverse()[(i, i)] * priors[i].deviation.powi(-2))
            .sum();
        Some((right.dot(&factor.solve(&right)), columns.len() as f64 - left))
    }

    /// Information and right side of some columns with their priors.
    fn posterior_terms(
        &self,
        columns: &[usize],
        priors: &[NormalPrior],
    ) -> (DMatrix<f64>, DVector<f64>) {
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

    /// Estimate of a hypothesis that has some of the effects' columns, with their priors.
    pub fn estimate_parameters(
        &self,
        columns: &[usize],
        priors: &[NormalPrior],
    ) -> Option<HypothesisEstimate> {
        let (information, right) = self.posterior_terms(columns, priors);
        let of = |fixing: &NormalPrior| {
            (fixing.mean / fixing.deviation).powi(2) + 2.0 * fixing.deviation.ln()
        };
        let prior: f64 = priors.iter().map(of).sum();
        let factor = Cholesky::new(information)?;
        let mean = factor.solve(&right);
        let log_determinant: f64 =
            2.0 * factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        Some(HypothesisEstimate {
            // log of the marginal likelihood ratio: (b' S b - m' P m + ln |P| + ln |S|) / 2.
            gain: 0.5 * (right.dot(&mean) - prior - log_determinant),
            mean,
            covariance: factor.inverse(),
        })
    }
}

/// Error for information that is not positive definite.
pub(super) fn not_positive_error() -> RefineError {
    RefineError::Data("the information matrix of the trials is not positive definite".into())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// One coefficient and one effect: what is left of the effect is its Schur complement, and
    /// information that is not positive is an error, not an absence of evidence.
    #[test]
    fn coefficients_are_integrated_out_or_the_reason_is_told() {
        let mut gram = GramMatrix::zeros(3);
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
        assert!(refusal.contains("information matrix of the trials is not positive"), "{refusal}");
    }
}
