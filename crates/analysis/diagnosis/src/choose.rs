//! Search from single effects to those that are missing together.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::DiagnosisInputs;
use super::constancy::is_last_inconstant;
use super::discount::is_external;
use super::effect_size::has_no_size;
use super::evidence::DiscrepancyFactor;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::limits::detection_limits;
use super::misfit::{is_as_published, misfit_share};
use super::outcome::DetectionLimit;
use super::placebo::is_placebo;
use super::refusal::Refusal;
use super::screening::{ScreenedEffect, screen_effects};
use super::search::HypothesisSearch;
use super::settings::Settings;
use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// All hypotheses that were judged.
pub(super) struct EffectChoice {
    /// The model alone.
    pub alone: JudgedHypothesis,
    /// Logarithm of its probability at its most probable level, including levels below that of the
    /// calibration.
    alone_at_any: f64,
    /// Detection limit of each effect.
    pub limits: Vec<DetectionLimit>,
    pub tried: Vec<JudgedHypothesis>,
    /// Index of the accepted one; none where the model alone is accepted.
    pub taken: Option<usize>,
    /// Levels of the discrepancy that are considered.
    levels: Vec<DiscrepancyFactor>,
}

/// Converged effects and coefficients, with the search about the model so calibrated.
pub(super) struct ConvergedChoice<'a> {
    pub search: HypothesisSearch<'a>,
    pub base: FilteredBase<'a>,
    pub best: JudgedHypothesis,
    /// Names of effects that were removed after the coefficients were fitted with them, and why.
    pub removed: Vec<(String, Refusal)>,
}

/// Judges single effects, then further ones together with the best, and exchanges each of a set for
/// every other. `base` is the one without effects.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn choose_effects(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    settings: &Settings,
) -> Result<EffectChoice, RefineError> {
    // The model alone at its most probable level is the reference of all evidence.
    let (level, alone) = search.judge_base(base)?;
    let limits = match search.states_odds {
        true => detection_limits(search, base, level, settings.least_evidence)?,
        false => Vec::new(),
    };
    // Also at levels below that of the calibration.
    let alone_at_any = search.judge_base_at(base, &|_| true)?.1.log_evidence;
    let (tried, levels) = (Vec::new(), search.levels.clone());
    let mut choice = EffectChoice { alone, alone_at_any, limits, tried, taken: None, levels };
    choice.add_effect(search, settings, base, THRESHOLDS.search.judged)?;
    // One effect is added at a time, until none is accepted; after each, the earlier ones may be
    // exchanged.
    while choice.taken.is_some() && choice.accepted_candidates().len() < settings.most_effects {
        let kept = choice.accepted_candidates();
        let base = search.filter_with_candidates(&kept, &choice.levels)?;
        choice.rebase(search, &base)?;
        if !choice.add_effect(search, settings, &base, THRESHOLDS.search.companions)? {
            break;
        }
        choice.exchange_effects(search, settings)?;
    }
    Ok(choice)
}

/// Evidence for the last effect of a hypothesis.
fn unlimited_last_evidence(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
) -> Result<f64, RefineError> {
    search.effect_evidence(judged, judged.candidates.len() - 1)
}

/// Most probable sets of the effects of a base and one more, linearised and judged at their
/// estimates.
fn judge_companions(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    count: usize,
) -> Result<Vec<JudgedHypothesis>, RefineError> {
    let likely = likely_candidates(screen_effects(search, base)?, count);
    let judged = |ScreenedEffect { candidate, level, .. }: &ScreenedEffect| {
        base.judge_once((candidate.candidate_key(), *level), || {
            search.judge_candidate(base, candidate, *level)
        })
    };
    likely.par_iter().map(judged).collect()
}

/// Candidates to be judged: half of them the most probable, then those with the most evidence after
/// their false-alarm levels, and in addition all that depend on a recorded external signal.
fn likely_candidates(screened: Vec<ScreenedEffect>, count: usize) -> Vec<ScreenedEffect> {
    let mut by_discounted = screened.clone();
    by_discounted.sort_by(|a, b| b.discounted.total_cmp(&a.discounted));
    let recorded: Vec<ScreenedEffect> =
        screened.iter().filter(|likely| is_external(&likely.candidate)).cloned().collect();
    let mut likely: Vec<ScreenedEffect> = screened.into_iter().take(count.div_ceil(2)).collect();
    for candidate in by_discounted {
        let is_new = likely
            .iter()
            .all(|known| known.candidate.candidate_key() != candidate.candidate.candidate_key());
        if is_new && likely.len() < count {
            likely.push(candidate);
        }
    }
    let keys: Vec<String> = likely.iter().map(|likely| likely.candidate.candidate_key()).collect();
    likely.extend(
        recorded.into_iter().filter(|recorded| !keys.contains(&recorded.candidate.candidate_key())),
    );
    likely
}

impl EffectChoice {
    fn accepted_candidates(&self) -> Vec<EffectCandidate> {
        self.taken.map(|taken| self.tried[taken].candidates.clone()).unwrap_or_default()
    }

    fn accept_hypothesis(&mut self, found: Vec<JudgedHypothesis>, best: Option<usize>) {
        if let Some(level) = best.map(|best| found[best].level) {
            // What an effect explains is no part of the discrepancy: with further effects it is not
            // larger.
            self.levels.truncate(1 + level);
        }
        self.taken = best.map(|best| self.tried.len() + best).or(self.taken);
        self.tried.extend(found);
    }

    /// Judges the accepted hypothesis again by the filter of a base linearised at its estimates,
    /// which is also that of further candidates.
    fn rebase(
        &mut self,
        search: &HypothesisSearch<'_>,
        base: &FilteredBase<'_>,
    ) -> Result<(), RefineError> {
        if let Some(taken) = self.taken {
            self.tried[taken] = search.judge_base(base)?.1;
        }
        Ok(())
    }

    /// Adds one effect, if any is accepted; returns true if so.
    fn add_effect(
        &mut self,
        search: &HypothesisSearch<'_>,
        settings: &Settings,
        base: &FilteredBase<'_>,
        count: usize,
    ) -> Result<bool, RefineError> {
        let mut found = judge_companions(search, base, count)?;
        let mut believed = Vec::new();
        for (place, hypothesis) in found.iter_mut().enumerate() {
            let evidence = self.last_evidence(search, hypothesis)?;
            hypothesis.refusal = self.refuse_hypothesis(search, hypothesis, settings, evidence)?;
            if hypothesis.refusal.is_none() {
                believed.push((evidence, place));
            }
        }
        // Accepted evidence decides, not the fit: a permanent error of an instrument would precede
        // what is new.
        believed.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut accepted: Vec<usize> = believed.into_iter().map(|(_, place)| place).collect();
        move_better_fits_forward(search, &found, &mut accepted);
        let mut better = None;
        // Placebos and pieces are costly, so they are judged only for those that could be accepted,
        // best first.
        for &place in &accepted {
            found[place].refusal = refuse_by_trials(search, &found[place], base)?;
            if found[place].refusal.is_none() {
                better = Some(place);
                break;
            }
        }
        base.release_gains();
        let ahead = better.and_then(|better| found[better].last_effect());
        for place in accepted.into_iter().filter(|place| Some(*place) != better) {
            let behind = ahead.clone().map(Refusal::Behind);
            found[place].refusal = found[place].refusal.take().or(behind);
        }
        self.accept_hypothesis(found, better);
        Ok(better.is_some())
    }

    /// Reverses a wrong step: each effect of a set except the last is exchanged for one that is
    /// more probable in its place. Combinations of the others with a new last one were evaluated
    /// just before.
    fn exchange_effects(
        &mut self,
        search: &HypothesisSearch<'_>,
        settings: &Settings,
    ) -> Result<(), RefineError> {
        let kept = self.accepted_candidates();
        for place in 0..kept.len() - 1 {
            let mut others = kept.clone();
            others.remove(place);
            let base = search.filter_with_candidates(&others, &self.levels)?;
            let mut found = judge_companions(search, &base, THRESHOLDS.search.companions)?;
            // The evidence of the effect to be replaced has to be exceeded by a margin.
            let mut least =
                search.effect_evidence(self.best_hypothesis(), place)? + THRESHOLDS.search.exchange;
            let mut better = None;
            for (at, judged) in found.iter_mut().enumerate() {
                let evidence = unlimited_last_evidence(search, judged)?;
                let refusal = self.refuse_last_effect(search, judged, settings, evidence)?;
                judged.refusal = refusal.or((evidence <= least).then_some(Refusal::NotBetter));
                if judged.refusal.is_none() {
                    (least, better) = (evidence, Some(at));
                }
            }
            self.accept_hypothesis(found, better);
            // One exchange at a time: the other effects are then part of a different set.
            if better.is_some() {
                break;
            }
        }
        Ok(())
    }

    /// Fits effects together with the coefficients until both converge, and removes effects that
    /// become redundant.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    pub(super) fn converge<'a>(
        &self,
        search: &HypothesisSearch<'a>,
        request: &DiagnosisInputs<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        let best = self.best_hypothesis().clone();
        self.converge_from((best, self.levels.clone()), search, request)
    }

    /// Fits the coefficients of the model alone until they converge.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    pub(super) fn converge_alone<'a>(
        &self,
        search: &HypothesisSearch<'a>,
        request: &DiagnosisInputs<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        self.converge_from((self.alone.clone(), search.levels.clone()), search, request)
    }

    fn converge_from<'a>(
        &self,
        (mut best, mut levels): (JudgedHypothesis, Vec<DiscrepancyFactor>),
        search: &HypothesisSearch<'a>,
        request: &DiagnosisInputs<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        let mut search = search.clone();
        let (mut rounds, mut removed) = (THRESHOLDS.search.joint_rounds, Vec::new());
        loop {
            // Coefficients and effects are fitted in turn, each with the others at their last
            // values.
            search = search.calibrated_by(request, &best)?;
            let base = search.filter_without_candidates(&best.candidates, &levels)?;
            best = search.judge_base(&base)?.1;
            rounds -= 1;
            if rounds > 0 {
                continue;
            }
            let redundant = self.redundant_effect(&search, &best, request.settings)?;
            let Some((place, refusal)) = redundant else {
                return Ok(ConvergedChoice { search, base, best, removed });
            };
            removed.push((best.candidates[place].effect.clone(), refusal));
            levels.clone_from(&search.levels);
            best = judge_without(&search, &best, place)?;
            // After a removal one round suffices: the others are near their estimates.
            rounds = 1;
        }
    }

    /// Appends the hypotheses of an earlier search that this one has not judged again.
    pub(super) fn merge_earlier(mut self, earlier: Self) -> Self {
        let again: BTreeSet<Vec<String>> =
            self.tried.iter().map(JudgedHypothesis::candidate_keys).collect();
        let is_new = |judged: &JudgedHypothesis| !again.contains(&judged.candidate_keys());
        self.tried.extend(earlier.tried.into_iter().filter(is_new));
        self
    }

    /// Marks the accepted hypothesis as refused.
    pub(super) fn refuse_accepted(&mut self, refusal: Refusal) {
        if let Some(taken) = self.taken {
            self.tried[taken].refusal = Some(refusal);
        }
    }

    pub(super) fn best_hypothesis(&self) -> &JudgedHypothesis {
        self.taken.map_or(&self.alone, |taken| &self.tried[taken])
    }

    /// Evidence for the last effect, limited to that of the whole hypothesis over the one without
    /// it: with columns linearised at the estimates, an effect whose columns change with its size
    /// would seem to have more.
    fn last_evidence(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
    ) -> Result<f64, RefineError> {
        let best = self.best_hypothesis().log_evidence;
        let is_outside = found.candidates.last().is_some_and(is_external);
        // An effect of a recorded external signal is part of the discrepancy of the calibration, so
        // it also competes with lower levels.
        let than = if is_outside { best.max(self.alone_at_any) } else { best };
        Ok(unlimited_last_evidence(search, found)?.min(found.log_evidence - than))
    }

    /// Reason for which a hypothesis is not more probable by enough, also on held-out trials; none
    /// where it is.
    fn refuse_hypothesis(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
        settings: &Settings,
        of_last: f64,
    ) -> Result<Option<Refusal>, RefineError> {
        let refusal = self.refuse_last_effect(search, found, settings, of_last)?;
        if refusal.is_some() {
            return Ok(refusal);
        }
        let held_out = |judged: &JudgedHypothesis| judged.held_out_log_probability(&search.fixed);
        let gain = held_out(found)? - held_out(self.best_hypothesis())?;
        // A gain that is not a number is none.
        Ok((gain.is_nan() || gain <= 0.0).then_some(Refusal::HeldOut { gain }))
    }

    /// Reason for which the last effect of a hypothesis is not evident: a form that does not agree
    /// with published coefficients, no size, or evidence that is not sufficient.
    fn refuse_last_effect(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
        settings: &Settings,
        of_last: f64,
    ) -> Result<Option<Refusal>, RefineError> {
        let last = found.candidates.len() - 1;
        let of_form = (0..=last).find_map(|place| refuse_form(found, place));
        let of_size = || refuse_size(found, last);
        if let Some(refusal) = of_form.or_else(of_size) {
            return Ok(Some(refusal));
        }
        let allowance = self.misfit_allowance(found, &all_evidence(search, found)?, last);
        Ok(refuse_evidence(found, (last, of_last), settings.least_evidence, allowance))
    }

    /// Index of an effect, of those judged together, that no longer agrees with its published form or
    /// has no size, or of the weakest one, if the evidence for it is not sufficient; with the reason.
    fn redundant_effect(
        &self,
        search: &HypothesisSearch<'_>,
        best: &JudgedHypothesis,
        settings: &Settings,
    ) -> Result<Option<(usize, Refusal)>, RefineError> {
        // An effect that its parameters exclude is removed first.
        let mut places = 0..best.candidates.len();
        let by_parameters =
            |place: usize| refuse_form(best, place).or_else(|| refuse_size(best, place));
        let refused = places.find_map(|place| Some((place, by_parameters(place)?)));
        if refused.is_some() {
            return Ok(refused);
        }
        let evidence = all_evidence(search, best)?;
        let weakest = (0..evidence.len()).min_by(|&a, &b| evidence[a].total_cmp(&evidence[b]));
        let refused = |place: usize| {
            let allowance = self.misfit_allowance(best, &evidence, place);
            let weakest = (place, evidence[place]);
            Some((place, refuse_evidence(best, weakest, settings.least_evidence, allowance)?))
        };
        Ok(weakest.and_then(refused))
    }

    /// Allowance for the misfit of the other effects of a set, whose published forms differ from
    /// the true ones: an effect with no more evidence than that may be due to this difference. It
    /// is zero for an effect of a recorded external signal, for which placebos would explain as
    /// much.
    ///
    /// The others explain the evidence of the set over the model alone except for this effect, each
    /// by its share. Evidence at the estimates of all is no measure of that: one may have a hundred
    /// times what it explains, since the level of the random accelerations is that of the whole
    /// set, or nearly none where another explains the same.
    fn misfit_allowance(&self, judged: &JudgedHypothesis, evidence: &[f64], place: usize) -> f64 {
        if is_external(&judged.candidates[place]) {
            return 0.0;
        }
        let of_set = judged.log_evidence - self.alone.log_evidence;
        let explained = (of_set - evidence[place].max(0.0)).max(0.0);
        let others = || (0..evidence.len()).filter(|other| *other != place);
        let sum: f64 = others().map(|other| evidence[other].max(0.0)).sum();
        let of = |other: usize| misfit_share(&judged.candidates[other]) * evidence[other].max(0.0);
        if sum > 0.0 { others().map(of).sum::<f64>() * explained / sum } else { 0.0 }
    }
}

/// Reason for which the last effect of a hypothesis is refused by other records, or by parts of the
/// trials.
fn refuse_by_trials(
    search: &HypothesisSearch<'_>,
    found: &JudgedHypothesis,
    base: &FilteredBase<'_>,
) -> Result<Option<Refusal>, RefineError> {
    let Some(last) = found.last_effect() else { return Ok(None) };
    if is_placebo(search, found, base)? {
        return Ok(Some(Refusal::Placebo(last)));
    }
    let is_asked = search.steady.as_ref().is_some_and(|steady| !steady.contains(&last));
    let varies = is_asked && is_last_inconstant(search, base, found)?;
    Ok(varies.then_some(Refusal::NotConstant(last)))
}

/// Judges a set of effects with one removed.
///
/// # Errors
/// Returns an error that names what a trial lacks.
fn judge_without(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    place: usize,
) -> Result<JudgedHypothesis, RefineError> {
    let mut kept = judged.candidates.clone();
    kept.remove(place);
    Ok(search.judge_base(&search.filter_without_candidates(&kept, &search.levels)?)?.1)
}

/// Moves forward the candidates that fit better than the most evident one by so much that their
/// improvement on clean trials cannot be the reason: the lead is divided by the false-alarm level,
/// as the information on the effect is.
fn move_better_fits_forward(
    search: &HypothesisSearch<'_>,
    found: &[JudgedHypothesis],
    accepted: &mut [usize],
) {
    let lead = |before: usize, than: usize| {
        let lead = found[before].log_evidence - found[than].log_evidence;
        // The lead of a candidate is divided by its own false-alarm level.
        let discount = |last: &EffectCandidate| search.candidate_discount(last);
        lead / found[before].candidates.last().map_or(1.0, discount)
    };
    for place in 1..accepted.len() {
        if lead(accepted[place], accepted[0]) > THRESHOLDS.search.exchange {
            accepted[..=place].rotate_right(1);
        }
    }
}

/// Reason for which the form of the effect at a place does not agree with published ones.
fn refuse_form(judged: &JudgedHypothesis, place: usize) -> Option<Refusal> {
    let candidate = &judged.candidates[place];
    (!is_as_published(candidate)).then(|| Refusal::NotAsPublished(candidate.effect.clone()))
}

/// Reason for which the size of the effect at a place is none.
fn refuse_size(judged: &JudgedHypothesis, place: usize) -> Option<Refusal> {
    has_no_size(judged, place).then(|| Refusal::NoSize(judged.candidates[place].effect.clone()))
}

/// Reason for which the evidence for the effect at a place is not above the least evidence, or the
/// allowance for the forms of the others.
fn refuse_evidence(
    judged: &JudgedHypothesis,
    (place, evidence): (usize, f64),
    least: f64,
    allowance: f64,
) -> Option<Refusal> {
    let effect = || judged.candidates[place].effect.clone();
    if evidence <= least {
        return Some(Refusal::LittleEvidence { effect: effect(), evidence, least });
    }
    (evidence <= allowance).then(|| Refusal::FormError { effect: effect(), evidence, allowance })
}

fn all_evidence(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
) -> Result<Vec<f64>, RefineError> {
    (0..judged.candidates.len()).map(|place| search.effect_evidence(judged, place)).collect()
}
