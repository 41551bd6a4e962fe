//! From single effects to those that are missing together.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::Request;
use super::discount::is_from_outside;
use super::evidence::DiscrepancyFactor;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::limits::limits;
use super::misfit::{is_as_published, shadow_share};
use super::outcome::DetectionLimit;
use super::placebo::is_placebo;
use super::screening::{ScreenedEffect, screen};
use super::search::HypothesisSearch;
use super::settings::Settings;
use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// Every hypothesis that was judged.
pub(super) struct EffectChoice {
    /// The model alone.
    pub alone: JudgedHypothesis,
    /// Logarithm of its probability at whichever level it is most probable, also below what
    /// calibration saw.
    alone_at_any: f64,
    /// How small each effect would have been shown.
    pub limits: Vec<DetectionLimit>,
    pub tried: Vec<JudgedHypothesis>,
    /// Place of the one taken; none where the model alone stands.
    pub taken: Option<usize>,
    /// Levels of the discrepancy that are still weighed.
    levels: Vec<DiscrepancyFactor>,
}

/// Effects and coefficients where both stay, and the search about the model so calibrated.
pub(super) struct ConvergedChoice<'a> {
    pub search: HypothesisSearch<'a>,
    pub base: FilteredBase<'a>,
    pub best: JudgedHypothesis,
}

/// Judges single effects, then what stands together with the best, exchanging each of a set for
/// every other. `base` is that without effects.
///
/// # Errors
/// Names what a trial lacks.
pub(super) fn choose(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    settings: &Settings,
) -> Result<EffectChoice, RefineError> {
    let (level, alone) = search.alone(base)?;
    let limits = match search.states_odds {
        true => limits(search, base, level, settings.least_evidence)?,
        false => Vec::new(),
    };
    let alone_at_any = search.alone_at(base, &|_| true)?.1.log_evidence;
    let (tried, levels) = (Vec::new(), search.levels.clone());
    let mut choice = EffectChoice { alone, alone_at_any, limits, tried, taken: None, levels };
    choice.add(search, settings, base, THRESHOLDS.search.judged)?;
    while choice.taken.is_some() && choice.kept().len() < settings.most_effects {
        let kept = choice.kept();
        let base = search.base(&kept, &choice.levels)?;
        choice.seen_from(search, &base)?;
        if !choice.add(search, settings, &base, THRESHOLDS.search.companions)? {
            break;
        }
        choice.exchange(search, settings)?;
    }
    Ok(choice)
}

/// The evidence for the effect that came last.
fn last_evidence(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
) -> Result<f64, RefineError> {
    search.evidence(judged, judged.candidates.len() - 1)
}

/// The most probable sets of those of a base and one more, judged where they stand.
fn companions(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    count: usize,
) -> Result<Vec<JudgedHypothesis>, RefineError> {
    let likely = likely(screen(search, base)?, count);
    let judged = |ScreenedEffect { candidate, level, .. }: &ScreenedEffect| {
        base.once((candidate.key(), *level), || search.judge(base, candidate, *level))
    };
    likely.par_iter().map(judged).collect()
}

/// The most probable, those that are believed most after their false-alarm levels, and whatever
/// follows a record from outside: its sensor is there to be asked.
fn likely(screened: Vec<ScreenedEffect>, count: usize) -> Vec<ScreenedEffect> {
    let mut by_discounted = screened.clone();
    by_discounted.sort_by(|a, b| b.discounted.total_cmp(&a.discounted));
    let recorded: Vec<ScreenedEffect> =
        screened.iter().filter(|likely| is_from_outside(&likely.candidate)).cloned().collect();
    let mut likely: Vec<ScreenedEffect> = screened.into_iter().take(count.div_ceil(2)).collect();
    for candidate in by_discounted {
        let is_new = likely.iter().all(|known| known.candidate.key() != candidate.candidate.key());
        if is_new && likely.len() < count {
            likely.push(candidate);
        }
    }
    let keys: Vec<String> = likely.iter().map(|likely| likely.candidate.key()).collect();
    likely
        .extend(recorded.into_iter().filter(|recorded| !keys.contains(&recorded.candidate.key())));
    likely
}

impl EffectChoice {
    fn kept(&self) -> Vec<EffectCandidate> {
        self.taken.map(|taken| self.tried[taken].candidates.clone()).unwrap_or_default()
    }

    fn take(&mut self, found: Vec<JudgedHypothesis>, best: Option<usize>) {
        self.taken = best.map(|best| self.tried.len() + best).or(self.taken);
        self.tried.extend(found);
    }

    /// What is taken judged anew by the filter of a base that stands where it does: what is tried
    /// beside it passes the same.
    fn seen_from(
        &mut self,
        search: &HypothesisSearch<'_>,
        base: &FilteredBase<'_>,
    ) -> Result<(), RefineError> {
        if let Some(taken) = self.taken {
            self.tried[taken] = search.alone(base)?.1;
        }
        Ok(())
    }

    /// One effect more, if any is believed.
    fn add(
        &mut self,
        search: &HypothesisSearch<'_>,
        settings: &Settings,
        base: &FilteredBase<'_>,
        count: usize,
    ) -> Result<bool, RefineError> {
        let found = companions(search, base, count)?;
        let mut believed = Vec::new();
        for (place, hypothesis) in found.iter().enumerate() {
            let evidence = self.last_evidence(search, hypothesis)?;
            if self.accepts(search, hypothesis, settings, evidence)? {
                believed.push((evidence, place));
            }
        }
        // What is believed decides, not what fits: an instrument that always erred would stand
        // before what is new.
        believed.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut accepted: Vec<usize> = believed.into_iter().map(|(_, place)| place).collect();
        fitting_first(search, &found, &mut accepted);
        let mut better = None;
        for place in accepted {
            if !is_placebo(search, &found[place], base)? {
                better = Some(place);
                break;
            }
        }
        self.take(found, better);
        Ok(better.is_some())
    }

    /// Undoes a wrong step: each of those taken together but the last is exchanged for whatever is
    /// more probable in its place. What goes with the others than the last has been tried just
    /// before.
    fn exchange(
        &mut self,
        search: &HypothesisSearch<'_>,
        settings: &Settings,
    ) -> Result<(), RefineError> {
        let kept = self.kept();
        for place in 0..kept.len() - 1 {
            let mut others = kept.clone();
            others.remove(place);
            let base = search.base(&others, &self.levels)?;
            let found = companions(search, &base, THRESHOLDS.search.companions)?;
            let best = search.evidence(self.best(), place)? + THRESHOLDS.search.exchange;
            let mut better: Option<(f64, usize)> = None;
            for (at, judged) in found.iter().enumerate() {
                let evidence = last_evidence(search, judged)?;
                let least = better.map_or(best, |(known, _)| known.max(best));
                if evidence > least && self.stands(search, judged, settings, evidence)? {
                    better = Some((evidence, at));
                }
            }
            let better = better.map(|(_, at)| at);
            self.take(found, better);
            if better.is_some() {
                break;
            }
        }
        Ok(())
    }

    /// Effects fitted together with the coefficients until both stay, without what the others then
    /// make needless.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub(super) fn settled<'a>(
        &self,
        search: &HypothesisSearch<'a>,
        request: &Request<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        self.settled_from(self.best().clone(), search, request)
    }

    /// The model alone, its coefficients fitted until they stay.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub(super) fn alone_settled<'a>(
        &self,
        search: &HypothesisSearch<'a>,
        request: &Request<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        self.settled_from(self.alone.clone(), search, request)
    }

    fn settled_from<'a>(
        &self,
        mut best: JudgedHypothesis,
        search: &HypothesisSearch<'a>,
        request: &Request<'_>,
    ) -> Result<ConvergedChoice<'a>, RefineError> {
        let mut search = search.clone();
        let mut rounds = THRESHOLDS.search.joint_rounds;
        loop {
            search = search.calibrated_by(request, &best)?;
            let base = search.bare(&best.candidates, &self.levels)?;
            best = search.alone(&base)?.1;
            rounds -= 1;
            if rounds > 0 {
                continue;
            }
            let Some(place) = self.needless(&search, &best, request.settings)? else {
                return Ok(ConvergedChoice { search, base, best });
            };
            best = self.without(&search, &best, place)?;
            rounds = 1;
        }
    }

    /// This choice, with what an earlier one has tried besides.
    pub(super) fn after(mut self, earlier: Self) -> Self {
        let keys = |judged: &JudgedHypothesis| {
            judged.candidates.iter().map(EffectCandidate::key).collect::<Vec<_>>()
        };
        let again: BTreeSet<Vec<String>> = self.tried.iter().map(keys).collect();
        self.tried
            .extend(earlier.tried.into_iter().filter(|judged| !again.contains(&keys(judged))));
        self
    }

    /// A set of effects but one.
    ///
    /// # Errors
    /// Names what a trial lacks.
    fn without(
        &self,
        search: &HypothesisSearch<'_>,
        judged: &JudgedHypothesis,
        place: usize,
    ) -> Result<JudgedHypothesis, RefineError> {
        let mut kept = judged.candidates.clone();
        kept.remove(place);
        Ok(search.alone(&search.bare(&kept, &self.levels)?)?.1)
    }

    pub(super) fn best(&self) -> &JudgedHypothesis {
        self.taken.map_or(&self.alone, |taken| &self.tried[taken])
    }

    /// The evidence for the effect that came last, which is not more than what the whole hypothesis
    /// has over the one without it: seen from where both stand, an effect of which the columns
    /// change with its size would be worth more.
    fn last_evidence(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
    ) -> Result<f64, RefineError> {
        let best = self.best().log_evidence;
        let is_outside = found.candidates.last().is_some_and(is_from_outside);
        let than = if is_outside { best.max(self.alone_at_any) } else { best };
        Ok(last_evidence(search, found)?.min(found.log_evidence - than))
    }

    /// A hypothesis is taken where it is more probable by enough, also on trials that its fit has
    /// not seen.
    fn accepts(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
        settings: &Settings,
        of_last: f64,
    ) -> Result<bool, RefineError> {
        let held_out = |judged: &JudgedHypothesis| judged.held_out(&search.fixed);
        Ok(self.stands(search, found, settings, of_last)?
            && held_out(found)? > held_out(self.best())?)
    }

    /// Whether all are such as authors have them, and the evidence for the one that came last is
    /// enough, and more than a shadow of the others'.
    fn stands(
        &self,
        search: &HypothesisSearch<'_>,
        found: &JudgedHypothesis,
        settings: &Settings,
        of_last: f64,
    ) -> Result<bool, RefineError> {
        let last = found.candidates.len() - 1;
        let evidence = all_evidence(search, found)?;
        Ok(found.candidates.iter().all(is_as_published)
            && of_last > settings.least_evidence.max(self.shadow(found, &evidence, last)))
    }

    /// One of effects that are judged together which has become another's, or the weakest, where
    /// the evidence for it is not enough.
    fn needless(
        &self,
        search: &HypothesisSearch<'_>,
        best: &JudgedHypothesis,
        settings: &Settings,
    ) -> Result<Option<usize>, RefineError> {
        let evidence = all_evidence(search, best)?;
        let weakest = (0..evidence.len()).min_by(|&a, &b| evidence[a].total_cmp(&evidence[b]));
        let other = best.candidates.iter().position(|candidate| !is_as_published(candidate));
        Ok(other.or(weakest.filter(|&place| {
            evidence[place] <= settings.least_evidence.max(self.shadow(best, &evidence, place))
        })))
    }

    /// What the others of a set leave unexplained where their forms are another author's than
    /// nature's: an effect beside them that explains no more may be that. It does not follow a
    /// record from outside: placebos would explain as much of it.
    ///
    /// The others explain what the set has over the model alone but for this effect, each its share
    /// of that. Seen from where all stand, one is worth a hundred times what it explains, for the
    /// level of the random accelerations is that of the whole set; or next to nothing, where
    /// another explains the same.
    fn shadow(&self, judged: &JudgedHypothesis, evidence: &[f64], place: usize) -> f64 {
        if is_from_outside(&judged.candidates[place]) {
            return 0.0;
        }
        let of_set = judged.log_evidence - self.alone.log_evidence;
        let explained = (of_set - evidence[place].max(0.0)).max(0.0);
        let others = || (0..evidence.len()).filter(|other| *other != place);
        let sum: f64 = others().map(|other| evidence[other].max(0.0)).sum();
        let of = |other: usize| shadow_share(&judged.candidates[other]) * evidence[other].max(0.0);
        if sum > 0.0 { others().map(of).sum::<f64>() * explained / sum } else { 0.0 }
    }
}

/// Puts in front whatever fits better than what is believed most by so much that what it explained
/// of clean trials cannot be the reason: where the information on an effect is divided by its
/// false-alarm level, so is the lead that it has.
fn fitting_first(
    search: &HypothesisSearch<'_>,
    found: &[JudgedHypothesis],
    accepted: &mut [usize],
) {
    let lead = |before: usize, than: usize| {
        let lead = found[before].log_evidence - found[than].log_evidence;
        let discount = |last: &EffectCandidate| search.discount(last);
        lead / found[before].candidates.last().map_or(1.0, discount)
    };
    for place in 1..accepted.len() {
        if lead(accepted[place], accepted[0]) > THRESHOLDS.search.exchange {
            accepted[..=place].rotate_right(1);
        }
    }
}

fn all_evidence(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
) -> Result<Vec<f64>, RefineError> {
    (0..judged.candidates.len()).map(|place| search.evidence(judged, place)).collect()
}
