//! Search for the most probable hypothesis: each effect alone, then sets of effects that improve on
//! it.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::DVector;
use sistership_model::law::Law;
use sistership_model::{Model, Trial};

use super::DiagnosisInputs;
use super::calibrated_model::CalibratedModel;
use super::coefficient_prior::CoefficientPrior;
use super::discount::{information_discount, is_external};
use super::effect_history::EffectHistory;
use super::evidence::{DiscrepancyFactor, MarginalInformation, NormalPrior, not_positive_error};
use super::filtered_base::FilteredBase;
use super::hypothesis::{JudgedHypothesis, candidate_priors, midpoint, move_candidates};
use super::linearised_trials::LinearisedTrials;
use super::nuisance::TermForms;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterColumns, GramMatrix, NuisanceColumn,
};
use sistership_identification::refine::RefineError;

/// Data that stay the same while hypotheses change.
#[derive(Clone)]
pub(super) struct HypothesisSearch<'a> {
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// Model as its own trials have calibrated it.
    pub calibrated_model: CalibratedModel,
    /// Shift of the coefficients, by column; and that before any hypothesis shifted them further.
    pub calibrated: Vec<f64>,
    pub calibrated_at_first: Vec<f64>,
    pub terms: TermForms,
    pub trials: &'a [&'a Trial],
    pub nuisance: Vec<NuisanceColumn>,
    pub fixed: CoefficientPrior,
    pub expected: AxisDiscrepancies,
    /// Levels of the discrepancy that are considered.
    pub levels: Vec<DiscrepancyFactor>,
    pub least_step_s: Option<f64>,
    /// Forms of the library's effects that are candidates.
    pub listed: Vec<EffectCandidate>,
    /// Terms that the model lacks.
    pub freed: Vec<EffectCandidate>,
    /// Forms that are candidates for a change within a trial only.
    pub changing: Vec<EffectCandidate>,
    /// Logarithm of the prior probability of each form among all.
    pub log_priors: BTreeMap<String, f64>,
    /// True if odds are stated. Libraries without odds have no detection limits, so that their
    /// diagnoses stay reproducible.
    pub states_odds: bool,
    /// Information of earlier trials on the effects.
    pub history: EffectHistory,
    /// Effects that were found constant where something remained unexplained: any other one must
    /// prove constant before it is accepted. None in the first search.
    pub steady: Option<BTreeSet<String>>,
    /// Names of the effects that differ from day to day: they do not belong to the ship.
    pub daily: BTreeSet<String>,
}

impl<'a> HypothesisSearch<'a> {
    /// Discrepancies at a level.
    pub fn level_discrepancies(&self, level: DiscrepancyFactor) -> AxisDiscrepancies {
        let scaled = |d: &sistership_model::uncertainty::Discrepancy| {
            let (deviation, white) = (d.deviation * level.factor, d.white * level.factor);
            sistership_model::uncertainty::Discrepancy { deviation, white, ..*d }
        };
        self.expected.iter().map(scaled).collect()
    }

    /// Prepares trials and columns.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn prepare_trials(
        &self,
        candidates: Vec<EffectCandidate>,
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        let columns = FilterColumns { nuisance: self.nuisance.clone(), candidates };
        LinearisedTrials::new(&self.calibrated_model, columns, self.trials, self.least_step_s)
    }

    /// Filters trials at some of the levels, with columns for some candidates.
    fn filter_candidates(
        &self,
        taken: &[EffectCandidate],
        candidates: Vec<EffectCandidate>,
        levels: &[DiscrepancyFactor],
    ) -> Result<FilteredBase<'a>, RefineError> {
        let columns = FilterColumns { nuisance: self.nuisance.clone(), candidates };
        let (model, step_s) = (&self.calibrated_model, self.least_step_s);
        let workspace =
            LinearisedTrials::linearised_on_demand(model, columns, self.trials, step_s)?;
        let levels = levels.iter().map(|&level| (level, self.level_discrepancies(level))).collect();
        FilteredBase::new(taken, workspace, levels)
    }

    /// Filters accepted effects with all others as candidates, at some of the levels.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn filter_with_candidates(
        &self,
        taken: &[EffectCandidate],
        levels: &[DiscrepancyFactor],
    ) -> Result<FilteredBase<'a>, RefineError> {
        // A missing term that is already a nuisance column needs no column of its own.
        let has_column = |candidate: &&EffectCandidate| {
            !self.nuisance.iter().any(|n| n.name == candidate.form.file.name)
        };
        let others = self.other_candidates(taken).into_iter().filter(has_column).cloned();
        self.filter_candidates(taken, taken.iter().cloned().chain(others).collect(), levels)
    }

    /// Filters accepted effects without candidates.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn filter_without_candidates(
        &self,
        taken: &[EffectCandidate],
        levels: &[DiscrepancyFactor],
    ) -> Result<FilteredBase<'a>, RefineError> {
        self.filter_candidates(taken, taken.to_vec(), levels)
    }

    /// Shift of the coefficients by the trials that are diagnosed.
    pub fn coefficient_shift(&self) -> Vec<f64> {
        self.calibrated
            .iter()
            .zip(&self.calibrated_at_first)
            .map(|(now, before)| now - before)
            .collect()
    }

    /// Removes all forms of an effect from the candidates.
    pub fn remove_effect(&mut self, effect: &str) {
        self.listed.retain(|candidate| candidate.effect != effect);
        self.freed.retain(|candidate| candidate.effect != effect);
    }

    /// Candidates of effects that are not accepted.
    pub fn other_candidates(&self, taken: &[EffectCandidate]) -> Vec<&EffectCandidate> {
        let is_other = |candidate: &&EffectCandidate| {
            !taken.iter().any(|kept| kept.effect == candidate.effect)
        };
        self.listed.iter().chain(&self.freed).filter(is_other).collect()
    }

    /// Returns the evidence for one of the effects judged together, given the others: discounted by
    /// its false-alarm level on clean trials, including the cost of the number of hypotheses.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn effect_evidence(
        &self,
        judged: &JudgedHypothesis,
        place: usize,
    ) -> Result<f64, RefineError> {
        let discount = self.candidate_discount(&judged.candidates[place]);
        self.discounted_evidence(judged, place, discount)
    }

    /// Returns the evidence for one of the effects judged together, as
    /// [`HypothesisSearch::effect_evidence`], with the information on it divided by `discount`.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn discounted_evidence(
        &self,
        judged: &JudgedHypothesis,
        place: usize,
        discount: f64,
    ) -> Result<f64, RefineError> {
        let candidate = &judged.candidates[place];
        let sizes: Vec<usize> =
            judged.linearised_at.iter().map(|linearised_at| linearised_at.at.len()).collect();
        let first: usize = sizes[..place].iter().sum();
        let own: Vec<usize> = (first..first + sizes[place]).collect();
        let others: Vec<usize> =
            (0..sizes.iter().sum()).filter(|column| !own.contains(column)).collect();
        let fixing: Vec<NormalPrior> =
            judged.linearised_at.iter().flat_map(candidate_priors).collect();
        let of =
            |columns: &[usize]| columns.iter().map(|&column| fixing[column]).collect::<Vec<_>>();
        let width = judged.grams.first().ok_or_else(not_positive_error)?.products.nrows();
        // The other effects are integrated out before the discount, which belongs to this effect
        // alone.
        let reduced =
            MarginalInformation::new(&GramMatrix::sum_parts(&judged.grams, width), &self.fixed)?
                .marginalise_others(&others, &of(&others), &own)
                .ok_or_else(not_positive_error)?;
        let reduced = reduced.divide_by(discount);
        let estimate = reduced
            .estimate_parameters(&(0..own.len()).collect::<Vec<_>>(), &of(&own))
            .ok_or_else(not_positive_error)?;
        let linearised_at =
            judged.linearised_at[place].at.iter().zip(candidate.form.parameters.values());
        // Relative to the likelihood at the absence of the effect, not at the point of
        // linearisation.
        let absent = reduced.log_likelihood_at(
            &linearised_at.map(|(at, parameter)| parameter.absent - at).collect::<Vec<_>>().into(),
        );
        Ok(estimate.gain - absent + self.log_prior(candidate))
    }

    /// Divisor of the information on an effect.
    pub fn candidate_discount(&self, candidate: &EffectCandidate) -> f64 {
        information_discount(
            self.model.uncertainty.as_ref(),
            candidate,
            &self.listed,
            self.trials.len() + self.history.trial_count(candidate),
        )
    }

    /// Logarithm of the prior probability of an effect among all candidates.
    pub fn log_prior(&self, candidate: &EffectCandidate) -> f64 {
        self.log_priors.get(&candidate.candidate_key()).copied().unwrap_or_default()
    }

    /// Prior odds of each effect against the model alone, all its forms together.
    pub fn prior_odds(&self) -> BTreeMap<String, f64> {
        let mut odds: BTreeMap<String, f64> = BTreeMap::new();
        for candidate in self.listed.iter().chain(&self.freed) {
            *odds.entry(candidate.effect.clone()).or_default() += self.log_prior(candidate).exp();
        }
        odds
    }

    /// Judges the effects of a base alone, at their most probable level.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks, or one if the information is not positive.
    pub fn judge_base(
        &self,
        base: &FilteredBase<'_>,
    ) -> Result<(usize, JudgedHypothesis), RefineError> {
        let outside = base.taken.iter().find(|candidate| is_external(candidate));
        self.judge_base_at(base, &|level| level.is_weighed(outside))
    }

    /// Judges the effects of a base alone at some of the levels.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks, or one if the information is not positive.
    pub fn judge_base_at(
        &self,
        base: &FilteredBase<'_>,
        is_weighed: &dyn Fn(DiscrepancyFactor) -> bool,
    ) -> Result<(usize, JudgedHypothesis), RefineError> {
        // The linearisation is the same at each level.
        let stand = base.prepare_hypothesis(&self.calibrated_model, &base.taken)?;
        let at = |level: usize| {
            let grams = stand.products_per_trial(level)?;
            Ok((level, self.judge_products((base, level), &base.taken, grams)?))
        };
        let levels = 0..base.levels.len();
        most_probable(levels.filter(|level| is_weighed(base.levels[*level].level)).map(at))
    }

    /// Judges a hypothesis together with the effects of a base, linearised again at its estimate
    /// until it converges. The gain of a step by one linearisation is accepted only after a
    /// linearisation at its end: an instrument's error multiplies the motion, so that such gains
    /// are many times too high, or of the wrong sign.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    pub fn judge_candidate(
        &self,
        base: &FilteredBase<'_>,
        candidate: &EffectCandidate,
        level: usize,
    ) -> Result<JudgedHypothesis, RefineError> {
        // The first linearisation is at the absence of the new effect.
        let absent = [base.taken.as_slice(), std::slice::from_ref(candidate)].concat();
        let promised = self.judge_at(base, &absent, level)?;
        let mut best = self.judge_at(base, &promised.1.candidates, promised.0)?;
        // The full step was worse than promised: half of it is evaluated too.
        if best.1.log_evidence < promised.1.log_evidence - THRESHOLDS.search.same {
            let less =
                self.judge_at(base, &midpoint(&absent, &promised.1.candidates), promised.0)?;
            best = if less.1.log_evidence > best.1.log_evidence { less } else { best };
        }
        for _ in 1..THRESHOLDS.search.rounds {
            let next = self.judge_at(base, &best.1.candidates, best.0)?;
            let gain = next.1.log_evidence - best.1.log_evidence;
            // Ends when a round gains nothing, or hardly anything.
            best = if gain > 0.0 { next } else { break };
            if gain < THRESHOLDS.search.same {
                break;
            }
        }
        Ok(best.1)
    }

    /// Returns this search with the model calibrated by a hypothesis.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn calibrated_by(
        &self,
        request: &DiagnosisInputs<'_>,
        judged: &JudgedHypothesis,
    ) -> Result<Self, RefineError> {
        let size = self.nuisance.len();
        let total = GramMatrix::sum_parts(
            &judged.grams,
            judged.grams.first().map_or(0, |gram| gram.products.nrows()),
        );
        let cross = total.products.view((1, 1 + size), (size, total.products.ncols() - 1 - size));
        // The right side at the estimate of the effects: b - G_ce (x - x0).
        let right = total.products.view((1, 0), (size, 1)).column(0)
            - cross * DVector::from_vec(judged.parameter_changes());
        let known = CoefficientPrior {
            information: total.products.view((1, 1), (size, size)) + &self.fixed.information,
            weighted_mean: right + &self.fixed.weighted_mean,
        };
        let shift = known.expected_shift(&self.nuisance).ok_or_else(not_positive_error)?;
        let calibrated: Vec<f64> =
            self.calibrated.iter().zip(&shift).map(|(before, more)| before + more).collect();
        Ok(Self {
            calibrated_model: CalibratedModel::new(
                request.model,
                request.law,
                &self.terms,
                &self.nuisance,
                &calibrated,
            )?,
            fixed: self.fixed.clone().relative_to(&shift),
            calibrated,
            ..self.clone()
        })
    }

    /// Judges candidates at their values, at a level or the one below, whichever is more probable.
    fn judge_at(
        &self,
        base: &FilteredBase<'_>,
        candidates: &[EffectCandidate],
        level: usize,
    ) -> Result<(usize, JudgedHypothesis), RefineError> {
        let stand = base.prepare_hypothesis(&self.calibrated_model, candidates)?;
        let at = |level: usize| {
            Ok((
                level,
                self.judge_products((base, level), candidates, stand.products_per_trial(level)?)?,
            ))
        };
        // A lower level may become more probable as effects explain part of the discrepancy.
        let is_weighed = |level: &usize| base.levels[*level].level.is_weighed(candidates.last());
        most_probable((level.saturating_sub(1)..=level).filter(is_weighed).map(at))
    }

    /// Judges candidates at a level of a base by the products of each trial.
    fn judge_products(
        &self,
        (base, level): (&FilteredBase<'_>, usize),
        candidates: &[EffectCandidate],
        mut grams: Vec<GramMatrix>,
    ) -> Result<JudgedHypothesis, RefineError> {
        if !self.history.forms.is_empty() {
            // Earlier trials are one more trial.
            grams.push(self.history.trial_products(self.nuisance.len(), candidates));
        }
        let priors: Vec<NormalPrior> = candidates.iter().flat_map(candidate_priors).collect();
        let places: Vec<usize> = (0..priors.len()).collect();
        let width = grams.first().ok_or_else(not_positive_error)?.products.nrows();
        let reduced = MarginalInformation::new(&GramMatrix::sum_parts(&grams, width), &self.fixed)?;
        let estimate =
            reduced.estimate_parameters(&places, &priors).ok_or_else(not_positive_error)?;
        let prior: f64 = candidates.iter().map(|candidate| self.log_prior(candidate)).sum();
        Ok(JudgedHypothesis {
            log_evidence: base.levels[level].level.log_prior - 0.5 * reduced.deviance
                + estimate.gain
                + prior,
            candidates: move_candidates(candidates.to_vec(), &estimate),
            linearised_at: candidates.to_vec(),
            shift: &reduced.shift - &reduced.answers * &estimate.mean,
            covariance: estimate.covariance,
            level,
            grams,
            refusal: None,
        })
    }
}

/// Returns the most probable of a hypothesis at some levels.
///
/// # Errors
/// Returns the first error of a level, or one if no level is considered.
fn most_probable(
    all: impl Iterator<Item = Result<(usize, JudgedHypothesis), RefineError>>,
) -> Result<(usize, JudgedHypothesis), RefineError> {
    let all: Vec<(usize, JudgedHypothesis)> = all.collect::<Result<_, _>>()?;
    let best = all.into_iter().max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence));
    best.ok_or_else(not_positive_error)
}
