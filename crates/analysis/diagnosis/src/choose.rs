//! Search from single effects to those that are missing together.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::DiagnosisInputs;
use super::discount::is_external;
use super::effect_size::parameter_refusal;
use super::evidence::DiscrepancyFactor;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::limits::detection_limits;
use super::misfit::{has_form_errors, is_as_published, misfit_share};
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
    /// Effects that were removed, with the reasons.
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
            match self.weigh_last_effect(search, hypothesis, settings)? {
                Ok(evidence) => believed.push((evidence, place)),
                Err(refusal) => hypothesis.refusal = Some(refusal),
            }
        }
        // Accepted evidence decides, not the fit: a permanent error of an instrument would precede
        // what is new.
        believed.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut accepted: Vec<usize> = believed.into_iter().map(|(_, place)| place).collect();
        move_better_fits_forward(search, &found, &mut accepted);
        let mut better = None;
        // Placebos are costly, so they are judged only for those that could be accepted, best
        // first.
        for &place in &accepted {
            if !is_placebo(search, &found[place], base)? {
                better = Some(place);
                break;
            }
            found[place].refusal = last_effect(&found[place]).map(Refusal::Placebo);
        }
        let names = better.and_then(|better| last_effect(&found[better]));
        for place in accepted.into_iter().filter(|place| Some(*place) != better) {
            let behind = names.clone().map(Refusal::Behind);
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
            let known = self.best_hypothesis().log_evidence;
            let mut better = None;
            for (at, judged) in found.iter_mut().enumerate() {
                let evidence = search.effect_evidence(judged, judged.candidates.len() - 1)?;
                let limits = (search, settings);
                let refusal = self.refuse_last_effect(limits, judged, evidence, f64::INFINITY)?;
                let is_behind = evidence <= least || judged.log_evidence <= known;
                judged.refusal = refusal.or(is_behind.then_some(Refusal::NotBetter));
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
        self.converge_from(self.best_hypothesis().clone(), search, request)
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
        self.converge_from(self.alone.clone(), search, request)
    }

    fn converge_from<'a>(
        &self,
        mut best: JudgedHypothesis,
        search: &HypothesisSearch<'a>,
        request: &DiagnosisInputs<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        let mut search = search.clone();
        let (mut rounds, mut removed) = (THRESHOLDS.search.joint_rounds, Vec::new());
        loop {
            // Coefficients and effects are fitted in turn, each with the others at their last
            // values.
            search = search.calibrated_by(request, &best)?;
            let base = search.filter_without_candidates(&best.candidates, &self.levels)?;
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
            best = self.judge_without(&search, &best, place)?;
            // After a removal one round suffices: the others are near their estimates.
            rounds = 1;
        }
    }

    /// Appends the hypotheses of an earlier search that this one has not judged again.
    pub(super) fn merge_earlier(mut self, earlier: Self) -> Self {
        let keys = |judged: &JudgedHypothesis| {
            judged.candidates.iter().map(EffectCandidate::candidate_key).collect::<Vec<_>>()
        };
        let again: BTreeSet<Vec<String>> = self.tried.iter().map(keys).collect();
        self.tried
            .extend(earlier.tried.into_iter().filter(|judged| !again.contains(&keys(judged))));
        self
    }

    /// Marks the accepted hypothesis as refused.
    pub(super) fn refuse_accepted(&mut self, refusal: Option<Refusal>) {
        if let Some(taken) = self.taken {
            self.tried[taken].refusal = refusal;
        }
    }

    /// Judges a set of effects with one removed.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    fn judge_without(
        &self,
        search: &HypothesisSearch<'_>,
        judged: &JudgedHypothesis,
        place: usize,
    ) -> Result<JudgedHypothesis, RefineError> {
        let mut kept = judged.candidates.clone();
        kept.remove(place);
        Ok(search.judge_base(&search.filter_without_candidates(&kept, &self.levels)?)?.1)
    }

    pub(super) fn best_hypothesis(&self) -> &JudgedHypothesis {
        self.taken.map_or(&self.alone, |taken| &self.tried[taken])
    }

    /// Evidence for the last effect, limited to that of the whole hypothesis over the one without
    /// it: with columns linearised at the estimates, an effect whose columns change with its size
    /// would seem to have more. Returns the reason where the hypothesis is not accepted.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    fn weigh_last_effect(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
        settings: &Settings,
    ) -> Result<Result<f64, Refusal>, RefineError> {
        let best = self.best_hypothesis();
        let is_outside = found.candidates.last().is_some_and(is_external);
        // An effect of a recorded external signal is part of the discrepancy of the calibration, so
        // it also competes with lower levels.
        let than = best.log_evidence.max(if is_outside { self.alone_at_any } else { f64::MIN });
        let last = found.candidates.len() - 1;
        let most = found.log_evidence - than;
        let evidence = gained_evidence(search, (found, last), most)?;
        let refusal = self.refuse_last_effect((search, settings), found, evidence, most)?;
        if let Some(refusal) = refusal {
            return Ok(Err(refusal));
        }
        let held_out = |judged: &JudgedHypothesis| judged.held_out_log_probability(&search.fixed);
        let gain = held_out(found)? - held_out(best)?;
        Ok(if gain > 0.0 { Ok(evidence) } else { Err(Refusal::HeldOut { gain }) })
    }

    /// Reason for which the last effect of a hypothesis is not accepted with an evidence; none
    /// where it is. `most` limits its evidence before the discount.
    fn refuse_last_effect(
        &self,
        (search, settings): (&HypothesisSearch<'_>, &Settings),
        found: &JudgedHypothesis,
        evidence: f64,
        most: f64,
    ) -> Result<Option<Refusal>, RefineError> {
        let last = found.candidates.len() - 1;
        let other = found.candidates.iter().find(|candidate| !is_as_published(candidate));
        if let Some(other) = other {
            return Ok(Some(Refusal::NotAsPublished(other.effect.clone())));
        }
        match parameter_refusal(found, last) {
            Some(refusal) => Ok(Some(refusal)),
            None => self.refuse_evidence((search, settings), (found, last), evidence, most),
        }
    }

    /// Reason for which the evidence for an effect of a set is not sufficient: after its
    /// improvement on clean trials it has to exceed the least evidence, and before that the
    /// allowance for the forms of the others. The two errors are independent of each other.
    fn refuse_evidence(
        &self,
        (search, settings): (&HypothesisSearch<'_>, &Settings),
        (judged, place): (&JudgedHypothesis, usize),
        evidence: f64,
        most: f64,
    ) -> Result<Option<Refusal>, RefineError> {
        let effect = || judged.candidates[place].effect.clone();
        let least = settings.least_evidence;
        if evidence <= least {
            return Ok(Some(Refusal::LittleEvidence { effect: effect(), evidence, least }));
        }
        let mut plain = plain_evidence(search, judged)?;
        // Where the hypothesis without the effect was judged, its evidence is the difference.
        if most.is_finite() {
            plain[place] = most;
        }
        let allowance = self.misfit_allowance(judged, &plain, place);
        let evidence = plain[place];
        Ok((evidence <= allowance).then(|| Refusal::FormError {
            effect: effect(),
            evidence,
            allowance,
        }))
    }

    /// Index of an effect, of those judged together, that cannot be named by its parameters, or of
    /// the weakest one, if the evidence for it is not sufficient; with the reason.
    fn redundant_effect(
        &self,
        search: &HypothesisSearch<'_>,
        best: &JudgedHypothesis,
        settings: &Settings,
    ) -> Result<Option<(usize, Refusal)>, RefineError> {
        let places = 0..best.candidates.len();
        let by_parameters =
            places.clone().find_map(|place| Some((place, parameter_refusal(best, place)?)));
        if by_parameters.is_some() {
            return Ok(by_parameters);
        }
        let mut each: Vec<(usize, f64)> = places
            .map(|place| Ok((place, search.effect_evidence(best, place)?)))
            .collect::<Result<_, RefineError>>()?;
        each.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (place, evidence) in each {
            let limits = (search, settings);
            if self.refuse_evidence(limits, (best, place), evidence, f64::INFINITY)?.is_none() {
                continue;
            }
            // With the errors of its form an effect seems to have less: it is judged without it.
            let without = self.judge_without(search, best, place)?;
            let most = best.log_evidence - without.log_evidence;
            let evidence = gained_evidence(search, (best, place), most)?;
            if let Some(refusal) = self.refuse_evidence(limits, (best, place), evidence, most)? {
                return Ok(Some((place, refusal)));
            }
        }
        Ok(None)
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

/// Evidence for each effect of a set, not discounted by the improvement on clean trials.
fn plain_evidence(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
) -> Result<Vec<f64>, RefineError> {
    let places = 0..judged.candidates.len();
    places.map(|place| search.discounted_effect_evidence(judged, place, 1.0)).collect()
}

/// Evidence for an effect of a set, discounted by its improvement on clean trials, where `most` is
/// that of the whole set over the one without it. At the estimates of all, the errors of its form
/// limit the evidence, but without the effect there are none: then that of the set counts, divided
/// as the information is.
fn gained_evidence(
    search: &HypothesisSearch<'_>,
    (judged, place): (&JudgedHypothesis, usize),
    most: f64,
) -> Result<f64, RefineError> {
    let own = search.effect_evidence(judged, place)?;
    let discounted = most / search.candidate_discount(&judged.candidates[place]);
    let limited = has_form_errors(&judged.candidates[place]);
    Ok(if limited { own.max(discounted) } else { own }.min(most))
}

fn last_effect(judged: &JudgedHypothesis) -> Option<String> {
    judged.candidates.last().map(|candidate| candidate.effect.clone())
}
