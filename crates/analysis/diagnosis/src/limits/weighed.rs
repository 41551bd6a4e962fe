//! The evidence that is expected for a candidate where an effect of some size is there.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::super::hypothesis::priors;
use super::super::search::HypothesisSearch;
use sistership_filtering::EffectCandidate;

/// What is expected of the evidence for an effect: mean and standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExpectedEvidence {
    pub mean: f64,
    pub deviation: f64,
}

/// Information on all candidates, and what the evidence for each of them needs of it.
pub(super) struct View {
    pub information: DMatrix<f64>,
    pub weighed: Vec<Option<WeighedCandidate>>,
}

impl View {
    /// Of candidates with their places in the information, each divided by a discount.
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

/// What the evidence for a candidate needs whatever the size is that is there. With `A` the
/// information and `P` the prior's, the gain is `g' S g/2` and a constant, `g = A t + P m` and `S =
/// (A + P)^-1`; chance adds `tr(S A)/2` to its mean.
pub(super) struct WeighedCandidate {
    discount: f64,
    /// `A`.
    information: DMatrix<f64>,
    /// Of `A + P`.
    factor: Cholesky<f64, Dyn>,
    /// `P m`.
    pulled: DVector<f64>,
    /// Twice the part of the mean that is the same for all sizes, without the odds.
    constant: f64,
    log_prior: f64,
    /// Of the square of `S A`.
    trace_of_square: f64,
}

impl WeighedCandidate {
    /// None where the information is not positive.
    fn new(
        search: &HypothesisSearch<'_>,
        candidate: &EffectCandidate,
        part: &DMatrix<f64>,
        discount: f64,
    ) -> Option<Self> {
        let fixing = priors(candidate);
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

    /// The evidence where the candidate sees so much, as the search would judge it: its information
    /// divided by its false-alarm level, its parameters integrated out, and the logarithm of its
    /// prior odds.
    pub fn expected(&self, seen: &DVector<f64>) -> ExpectedEvidence {
        let right = seen / self.discount + &self.pulled;
        let mean = self.factor.solve(&right);
        let variance = mean.dot(&(&self.information * &mean)) + 0.5 * self.trace_of_square;
        ExpectedEvidence {
            mean: 0.5 * (right.dot(&mean) + self.constant) + self.log_prior,
            deviation: variance.max(0.0).sqrt(),
        }
    }
}
