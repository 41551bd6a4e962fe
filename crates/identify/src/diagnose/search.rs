//! Which hypothesis is most probable: every effect alone, then those together that improve on it.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use sistership_model::law::Law;
use sistership_model::{Model, Trial};

use super::evidence::{Estimate, Fixed, Fixing, Level, Reduced};
use super::nuisance::Terms;
use super::workspace::Workspace;
use crate::refine::RefineError;
use crate::residual::{Candidate, Columns, Discrepancies, Gram, Nuisance};

/// Rounds in which a hypothesis is linearised anew where it stands.
const ROUNDS: usize = 3;

/// What stays the same while hypotheses change.
pub(super) struct Search<'a> {
    pub model: &'a Model,
    pub law: &'a Law,
    pub trials: &'a [&'a Trial],
    pub nuisance: Vec<Nuisance>,
    pub terms: Terms,
    pub fixed: Fixed,
    pub expected: Discrepancies,
    /// Levels of the discrepancy that are weighed.
    pub levels: Vec<Level>,
    pub least_step_s: Option<f64>,
    /// Logarithm of the prior probability of each form among all.
    pub log_priors: std::collections::BTreeMap<String, f64>,
}

/// A hypothesis where it is most probable.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub candidates: Vec<Candidate>,
    /// Logarithm of the probability of the readings and of the hypothesis itself.
    pub log_evidence: f64,
    pub covariance: DMatrix<f64>,
    /// Change of the coefficients.
    pub shift: DVector<f64>,
    /// Products of each trial under the most probable discrepancies, at `stood`.
    pub grams: Vec<Gram>,
    /// Where the candidates stood when the columns were made.
    pub stood: Vec<Candidate>,
}

impl Search<'_> {
    fn discrepancies(&self, level: Level) -> Discrepancies {
        let scaled = |d: &sistership_model::uncertainty::Discrepancy| {
            let (deviation, white) = (d.deviation * level.factor, d.white * level.factor);
            sistership_model::uncertainty::Discrepancy { deviation, white, ..*d }
        };
        self.expected.iter().map(scaled).collect()
    }

    /// Trials and columns made ready.
    pub fn workspace(&self, candidates: Vec<Candidate>) -> Result<Workspace<'_>, RefineError> {
        let columns = Columns { nuisance: self.nuisance.clone(), candidates };
        Workspace::new(self.model, self.law, columns, &self.terms, self.trials, self.least_step_s)
    }

    /// The evidence of each candidate together with those `taken`, from one linearisation at the absence of all others, most
    /// probable first.
    pub fn screen(&self, taken: &[Candidate], candidates: &[Candidate]) -> Result<Vec<(f64, Candidate)>, RefineError> {
        let workspace = self.workspace([taken, candidates].concat())?;
        let reduced: Vec<(Level, Reduced)> = self
            .levels
            .iter()
            .filter_map(|&level| Some((level, Reduced::new(&workspace.total(&self.discrepancies(level)), &self.fixed)?)))
            .collect();
        let one = |(place, candidate): (usize, &Candidate)| {
            let own = workspace.columns().places(taken.len() + place);
            let before = (0..taken.len()).flat_map(|place| workspace.columns().places(place));
            let places: Vec<usize> = before.chain(own).map(|p| p - self.nuisance.len()).collect();
            let fixing: Vec<Fixing> = taken.iter().chain([candidate]).flat_map(priors).collect();
            let gain = |(level, reduced): &(Level, Reduced)| {
                Some(level.log_prior - 0.5 * reduced.deviance + reduced.estimate(&places, &fixing)?.gain)
            };
            let best = reduced.iter().filter_map(gain).fold(f64::NEG_INFINITY, f64::max);
            (best + self.log_prior(candidate), candidate.clone())
        };
        let mut screened: Vec<(f64, Candidate)> = candidates.iter().enumerate().map(one).collect();
        screened.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(screened)
    }

    fn log_prior(&self, candidate: &Candidate) -> f64 {
        self.log_priors.get(&candidate.key()).copied().unwrap_or_default()
    }

    /// A hypothesis, linearised anew where it stands until it stays there.
    pub fn judge(&self, candidates: &[Candidate]) -> Result<Judged, RefineError> {
        let mut best = self.judged(candidates.to_vec())?;
        for _ in 0..if candidates.is_empty() { 0 } else { ROUNDS } {
            let next = self.judged(self.moved(&best))?;
            let gain = next.log_evidence - best.log_evidence;
            best = if gain > 0.0 { next } else { break };
            if gain < 0.5 {
                break;
            }
        }
        Ok(best)
    }

    /// The candidates at their estimates, within their bounds.
    fn moved(&self, judged: &Judged) -> Vec<Candidate> {
        judged
            .candidates
            .iter()
            .map(|candidate| {
                let bounded = candidate.at.iter().zip(candidate.form.parameters.values());
                let at = bounded.map(|(value, parameter)| value.clamp(parameter.bounds[0], parameter.bounds[1])).collect();
                Candidate { at, ..candidate.clone() }
            })
            .collect()
    }

    /// A hypothesis from one linearisation; its candidates come back at their estimates.
    fn judged(&self, candidates: Vec<Candidate>) -> Result<Judged, RefineError> {
        let workspace = self.workspace(candidates.clone())?;
        let columns: Vec<usize> = (0..workspace.columns().len() - self.nuisance.len()).collect();
        let priors: Vec<Fixing> = candidates.iter().flat_map(priors).collect();
        let at_level = |level: Level| {
            let discrepancies = self.discrepancies(level);
            let grams = workspace.each(&discrepancies);
            let total = Gram::sum(&grams, 1 + workspace.columns().len());
            let reduced = Reduced::new(&total, &self.fixed)?;
            let estimate = reduced.estimate(&columns, &priors)?;
            Some((level.log_prior - 0.5 * reduced.deviance + estimate.gain, grams, reduced, estimate))
        };
        let levels: Vec<_> = self.levels.par_iter().copied().filter_map(at_level).collect();
        let total = log_sum(levels.iter().map(|level| level.0));
        let best = levels.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (_, grams, reduced, estimate) =
            best.ok_or_else(|| RefineError::Data("the trials' information is not positive".into()))?;
        let prior: f64 = candidates.iter().map(|candidate| self.log_prior(candidate)).sum();
        let shift = &reduced.shift - &reduced.answers * &estimate.mean;
        Ok(Judged {
            log_evidence: total + prior,
            candidates: placed(candidates.clone(), &estimate),
            stood: candidates,
            covariance: estimate.covariance,
            shift,
            grams,
        })
    }
}

impl Judged {
    /// Logarithm of the probability of some of the trials under this hypothesis, and its estimate there.
    pub fn of_trials(&self, fixed: &Fixed, keep: &dyn Fn(usize) -> bool) -> Option<(f64, Vec<Candidate>)> {
        let width = self.grams.first()?.products.nrows();
        let kept = self.grams.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, gram)| gram);
        let reduced = Reduced::new(&Gram::sum(kept, width), fixed)?;
        let columns: Vec<usize> = (0..width - 1 - fixed.weighted_mean.len()).collect();
        let priors: Vec<Fixing> = self.stood.iter().flat_map(priors).collect();
        let estimate = reduced.estimate(&columns, &priors)?;
        Some((estimate.gain - 0.5 * reduced.deviance, placed(self.stood.clone(), &estimate)))
    }

    /// How probable each trial is by a fit on the others: the sum of the logarithms.
    pub fn held_out(&self, fixed: &Fixed) -> Option<f64> {
        let (all, ..) = self.of_trials(fixed, &|_| true)?;
        let without = |trial: usize| Some(all - self.of_trials(fixed, &|other| other != trial)?.0);
        (0..self.grams.len()).map(without).sum()
    }
}

/// The priors of a candidate's parameters, as distances from where it stands.
pub(super) fn priors(candidate: &Candidate) -> Vec<Fixing> {
    let one = |(at, parameter): (&f64, &sistership_model::effect::EffectParameter)| Fixing {
        mean: parameter.prior_mean - at,
        deviation: parameter.prior_deviation,
    };
    candidate.at.iter().zip(candidate.form.parameters.values()).map(one).collect()
}

fn placed(mut candidates: Vec<Candidate>, estimate: &Estimate) -> Vec<Candidate> {
    let mut means = estimate.mean.iter();
    for candidate in &mut candidates {
        candidate.form = Arc::clone(&candidate.form);
        candidate.at.iter_mut().zip(&mut means).for_each(|(at, mean)| *at += mean);
    }
    candidates
}

fn log_sum(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    largest + values.map(|value| (value - largest).exp()).sum::<f64>().ln()
}
