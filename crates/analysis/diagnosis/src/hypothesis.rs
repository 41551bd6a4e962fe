//! A hypothesis: effects that may be missing together, at their most probable values.

use nalgebra::{DMatrix, DVector};
use sistership_model::effect::EffectParameter;

use super::coefficient_prior::CoefficientPrior;
use super::evidence::{HypothesisEstimate, MarginalInformation, NormalPrior, not_positive_error};
use super::refusal::Refusal;
use sistership_filtering::{EffectCandidate, GramMatrix};
use sistership_identification::refine::RefineError;

/// A hypothesis at its most probable values.
#[derive(Debug, Clone)]
pub(super) struct JudgedHypothesis {
    pub candidates: Vec<EffectCandidate>,
    /// Logarithm of the probability of the readings and of the hypothesis itself.
    pub log_evidence: f64,
    pub covariance: DMatrix<f64>,
    /// Level of the discrepancy, among those of the base by which it was judged.
    pub level: usize,
    /// Change of the coefficients.
    pub shift: DVector<f64>,
    /// Products of each trial under the most probable discrepancies, at `linearised_at`.
    pub grams: Vec<GramMatrix>,
    /// Values of the candidates at which the columns are tangents.
    pub linearised_at: Vec<EffectCandidate>,
    /// Reason for which it was not accepted, where it was considered and refused.
    pub refusal: Option<Refusal>,
}

impl JudgedHypothesis {
    /// Keys of the effects, in their order.
    pub fn candidate_keys(&self) -> Vec<String> {
        self.candidates.iter().map(EffectCandidate::candidate_key).collect()
    }

    /// Name of the effect that was added last.
    pub fn last_effect(&self) -> Option<String> {
        self.candidates.last().map(|candidate| candidate.effect.clone())
    }

    /// Returns true if another hypothesis has the same effects, in any order.
    pub fn has_same_effects(&self, other: &Self) -> bool {
        let (own, others) = (self.candidate_keys(), other.candidate_keys());
        own.len() == others.len() && own.iter().all(|key| others.contains(key))
    }

    /// Distance of each parameter from the values of the linearisation.
    pub fn parameter_changes(&self) -> Vec<f64> {
        let pairs = self.candidates.iter().zip(&self.linearised_at);
        pairs.flat_map(|(here, there)| here.at.iter().zip(&there.at).map(|(a, b)| a - b)).collect()
    }

    /// Returns the logarithm of the probability of some of the trials under this hypothesis, and
    /// its estimate on them.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn evaluate_trials(
        &self,
        fixed: &CoefficientPrior,
        keep: &dyn Fn(usize) -> bool,
    ) -> Result<(f64, Vec<EffectCandidate>), RefineError> {
        let width = self.grams.first().ok_or_else(not_positive_error)?.products.nrows();
        let kept =
            self.grams.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, gram)| gram);
        let reduced = MarginalInformation::new(&GramMatrix::sum_parts(kept, width), fixed)?;
        let columns: Vec<usize> = (0..width - 1 - fixed.weighted_mean.len()).collect();
        let priors: Vec<NormalPrior> =
            self.linearised_at.iter().flat_map(candidate_priors).collect();
        let estimate =
            reduced.estimate_parameters(&columns, &priors).ok_or_else(not_positive_error)?;
        Ok((
            estimate.gain - 0.5 * reduced.deviance,
            move_candidates(self.linearised_at.clone(), &estimate),
        ))
    }

    /// Returns the sum over trials of the logarithm of each trial's probability, given a fit on the
    /// others.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn held_out_log_probability(&self, fixed: &CoefficientPrior) -> Result<f64, RefineError> {
        let (all, ..) = self.evaluate_trials(fixed, &|_| true)?;
        // ln p(trial | others) = ln p(all) - ln p(others).
        let without =
            |trial: usize| Ok(all - self.evaluate_trials(fixed, &|other| other != trial)?.0);
        (0..self.grams.len()).map(without).sum()
    }
}

/// Values halfway between two sets of values of the same candidates.
pub(super) fn midpoint(from: &[EffectCandidate], to: &[EffectCandidate]) -> Vec<EffectCandidate> {
    let between = |(from, to): (&EffectCandidate, &EffectCandidate)| {
        let at = from.at.iter().zip(&to.at).map(|(from, to)| 0.5 * (from + to)).collect();
        EffectCandidate { at, ..to.clone() }
    };
    from.iter().zip(to).map(between).collect()
}

/// Priors of a candidate's parameters, as distances from its values.
pub(super) fn candidate_priors(candidate: &EffectCandidate) -> Vec<NormalPrior> {
    let one = |(at, parameter): (&f64, &EffectParameter)| NormalPrior {
        mean: parameter.prior_mean - at,
        deviation: parameter.prior_deviation,
    };
    candidate.at.iter().zip(candidate.form.parameters.values()).map(one).collect()
}

/// Candidates at an estimate, within the bounds of their parameters.
pub(super) fn move_candidates(
    mut candidates: Vec<EffectCandidate>,
    estimate: &HypothesisEstimate,
) -> Vec<EffectCandidate> {
    let mut means = estimate.mean.iter();
    for candidate in &mut candidates {
        let parameters = candidate.form.parameters.values();
        for ((at, parameter), mean) in candidate.at.iter_mut().zip(parameters).zip(&mut means) {
            *at = (*at + mean).clamp(parameter.bounds[0], parameter.bounds[1]);
        }
    }
    candidates
}
