//! Expected evidence for a candidate where an effect of some size is present.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::super::hypothesis::candidate_priors;
use super::super::search::HypothesisSearch;
use sistership_filtering::EffectCandidate;

/// Expected evidence for an effect: mean and standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExpectedEvidence {
    pub mean: f64,
    pub deviation: f64,
}

/// Information on all candidates, with the terms of the evidence for each of them.
pub(super) struct InformationView {
    pub information: DMatrix<f64>,
    pub weighed: Vec<Option<WeighedCandidate>>,
}

impl InformationView {
    /// Creates a view from candidates and the indices of their columns, each divided by a discount.
    pub fn new(
        search: &HypothesisSearch<'_>,
        information: DMatrix<f64>,
        (candidates, places): (&[&EffectCandidate], &[Vec<usize>]),
        discount: &dyn Fn(&EffectCandidate) -> f64,
    ) -> Self {
        let weighed = |(candidate, own): (&&EffectCandidate, &Vec<usize>)| {
            let part = DMatrix::from_fn(own.len(), own.len(), |i, j| information[(own[i], own[j])]);
            WeighedCandidate::new(search, candidate, &part, discount(candidate))
        };
        let weighed = candidates.iter().zip(places).map(weighed).collect();
        Self { information, weighed }
    }
}

/// Terms of the evidence for a candidate that do not depend on the size that is present. With `A`
/// the information and `P` the prior's, the gain is `g' S g/2` and a constant, `g = A t + P m` and
/// `S = (A + P)^-1`; chance adds `tr(S A)/2` to its mean.
pub(super) struct WeighedCandidate {
    discount: f64,
    /// Information `A`.
    information: DMatrix<f64>,
    /// Cholesky factor of `A + P`.
    factor: Cholesky<f64, Dyn>,
    /// Product `P m`.
    pulled: DVector<f64>,
    /// Twice the part of the mean that is the same for all sizes, without the odds.
    constant: f64,
    log_prior: f64,
    /// Trace of the square of `S A`.
    trace_of_square: f64,
}

impl WeighedCandidate {
    /// Returns none where the information is not positive.
    fn new(
        search: &HypothesisSearch<'_>,
        candidate: &EffectCandidate,
        part: &DMatrix<f64>,
        discount: f64,
    ) -> Option<Self> {
        let fixing = candidate_priors(candidate);
        let precision = DVector::from_iterator(
            fixing.len(),
            fixing.iter().map(|prior| prior.deviation.powi(-2)),
        );
        let information = part / discount;
        let factor = Cholesky::new(&information + DMatrix::from_diagonal(&precision))?;
        let pulled = fixing.iter().zip(precision.iter()).map(|(prior, p)| p * prior.mean);
        let pulled = DVector::from_iterator(fixing.len(), pulled);
        let log_determinant: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
        let of_prior: f64 = fixing
            .iter()
            .map(|prior| (prior.mean / prior.deviation).powi(2) + 2.0 * prior.deviation.ln())
            .sum();
        // The product S A, whose trace is the expected gain by chance.
        let spread = factor.solve(&information);
        Some(Self {
            discount,
            information,
            factor,
            pulled,
            constant: spread.trace() - log_determinant - of_prior,
            log_prior: search.log_prior(candidate),
            trace_of_square: (&spread * &spread).trace(),
        })
    }

    /// Expected evidence for a given response of the candidate, as the search would judge it: its
    /// information divided by its false-alarm level, its parameters integrated out, and the
    /// logarithm of its prior odds added.
    pub fn expected_evidence(&self, seen: &DVector<f64>) -> ExpectedEvidence {
        let right = seen / self.discount + &self.pulled;
        let mean = self.factor.solve(&right);
        // Variance of a quadratic form in a normal variable: g' S A S g + tr((S A)^2) / 2.
        let variance = mean.dot(&(&self.information * &mean)) + 0.5 * self.trace_of_square;
        ExpectedEvidence {
            mean: 0.5 * (right.dot(&mean) + self.constant) + self.log_prior,
            deviation: variance.max(0.0).sqrt(),
        }
    }
}
