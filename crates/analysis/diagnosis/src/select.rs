//! Which effects are taken in the end: those that are the same at all times, or none where changes
//! within trials explain everything.

use super::Request;
use super::changes::{changes, open};
use super::choose::{ConvergedChoice, EffectChoice, choose};
use super::constancy::inconstant;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use super::misfit::of_shape;
use super::outcome::{Change, Unexplained};
use super::remainder::unexplained;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{Discrepancies, EffectCandidate};
use sistership_identification::refine::{Progress, RefineError};

/// What is taken in the end.
pub(super) struct SelectedEffects<'a> {
    pub choice: EffectChoice,
    pub settled: ConvergedChoice<'a>,
    pub remaining: Vec<Unexplained>,
    pub changes: Vec<Change>,
    /// Names of effects that are not the same at all times.
    pub refused: Vec<String>,
}

/// The effects taken, as far as each is the same at all times where something remains unexplained.
/// Where one is not, the choice is made again without it: it may have stood before another. Whether
/// changes within trials are all that there is, is asked first: choosing again takes as long as
/// everything before. `base` is that of the first search without effects.
///
/// # Errors
/// Names what a trial lacks.
pub(super) fn selected<'a>(
    request: &Request<'_>,
    (first, base): (&HypothesisSearch<'a>, &FilteredBase<'a>),
    mut choice: EffectChoice,
    progress: Progress<'_>,
) -> Result<SelectedEffects<'a>, RefineError> {
    let (mut search, mut refused) = (first.clone(), Vec::new());
    loop {
        let state = LeftState::of(choice.settled(&search, request)?)?;
        let varying = state.varying(request.settings.least_evidence)?;
        let is_asked = refused.is_empty() || varying.is_empty();
        if is_asked && !state.remaining.is_empty() && !state.named().is_empty() {
            told(progress, "whether something changed within trials instead")?;
            let steady = state.names(|place| !varying.contains(&place));
            if let Some((state, changes)) = only_changes(request, first, &choice, &steady)? {
                refused.extend(choice.best().candidates.iter().map(|one| one.effect.clone()));
                choice.taken = None;
                return Ok(state.with(choice, changes, refused));
            }
        }
        if varying.is_empty() {
            told(progress, "what changes within trials")?;
            let changes = state.changes(request, first)?;
            return Ok(state.with(choice, changes, refused));
        }
        let names = state.names(|place| varying.contains(&place)).into_iter();
        refused.extend(names.inspect(|name| search.forget(name)));
        told(progress, "effects without those that only resemble what is missing")?;
        choice = choose(&search, base, request.settings)?.after(choice);
    }
}

/// Effects and coefficients where both stay, and what they leave.
struct LeftState<'a> {
    settled: ConvergedChoice<'a>,
    remaining: Vec<Unexplained>,
}

impl<'a> LeftState<'a> {
    fn of(settled: ConvergedChoice<'a>) -> Result<Self, RefineError> {
        let remaining = remaining(&settled.search, &settled.best, &settled.base.workspace)?;
        Ok(Self { settled, remaining })
    }

    fn named(&self) -> &[EffectCandidate] {
        &self.settled.best.candidates
    }

    fn names(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<String> {
        let wanted = self.named().iter().enumerate().filter(|(place, _)| is_wanted(*place));
        wanted.map(|(_, candidate)| candidate.effect.clone()).collect()
    }

    /// The effects that are not the same at all times, where something remains.
    fn varying(&self, margin: f64) -> Result<Vec<usize>, RefineError> {
        let ConvergedChoice { search, base, best } = &self.settled;
        match self.remaining.is_empty() {
            true => Ok(Vec::new()),
            false => inconstant(search, base, best, margin),
        }
    }

    /// Changes within trials beside what is taken.
    fn changes(
        &self,
        request: &Request<'_>,
        first: &HypothesisSearch<'_>,
    ) -> Result<Vec<Change>, RefineError> {
        let all = (&self.settled.search, &self.settled.best, first.listed.as_slice());
        changes(all, &self.remaining, request.settings.least_evidence)
    }

    /// An effect that changes is not told as one that only resembles what is missing.
    fn with(
        self,
        choice: EffectChoice,
        changes: Vec<Change>,
        mut refused: Vec<String>,
    ) -> SelectedEffects<'a> {
        refused.retain(|name| changes.iter().all(|change| change.effect != *name));
        let Self { settled, remaining } = self;
        SelectedEffects { choice, settled, remaining, changes, refused }
    }
}

fn told(progress: Progress<'_>, what: &str) -> Result<(), RefineError> {
    if progress(0.8, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// The model without effects, where what it leaves is nothing but changes of one effect, by more
/// evidence than that for the effects taken: these only resembled the changes. An effect that is
/// `steady` is no change.
fn only_changes<'a>(
    request: &Request<'_>,
    first: &HypothesisSearch<'a>,
    choice: &EffectChoice,
    steady: &[String],
) -> Result<Option<(LeftState<'a>, Vec<Change>)>, RefineError> {
    let state = LeftState::of(choice.alone_settled(first, request)?)?;
    if open(&state.remaining).len() > THRESHOLDS.changes.asked {
        return Ok(None);
    }
    let changes = state.changes(request, first)?;
    let is_told = |open: &Unexplained| changes.iter().any(|change| change.trial == open.trial);
    let is_steady = changes.iter().any(|change| steady.contains(&change.effect));
    let evidence: f64 = changes.iter().map(|change| change.evidence).sum();
    let of_effects = choice.best().log_evidence - choice.alone.log_evidence;
    let is_all = !is_steady && state.remaining.iter().all(is_told) && evidence > of_effects;
    Ok(is_all.then_some((state, changes)))
}

/// The discrepancy by which it is judged what remains.
pub(super) fn expected(
    search: &HypothesisSearch<'_>,
    workspace: &LinearisedTrials<'_>,
) -> Discrepancies {
    match search.model.uncertainty {
        Some(_) => search.expected.clone(),
        None => workspace.scales().discrepancies(THRESHOLDS.discrepancy.remainder_level),
    }
}

/// By how much each column moved.
pub(super) fn parameters(best: &JudgedHypothesis) -> Vec<f64> {
    best.shift.iter().copied().chain(best.moved()).collect()
}

fn remaining(
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
    workspace: &LinearisedTrials<'_>,
) -> Result<Vec<Unexplained>, RefineError> {
    let (expected, parameters) = (&expected(search, workspace), parameters(best));
    let clean = search.model.uncertainty.as_ref().map(|uncertainty| &uncertainty.remainder);
    let open = |candidate: &EffectCandidate| {
        let share = of_shape(candidate);
        candidate.change().into_iter().map(move |change| share * change)
    };
    let changes: Vec<f64> = best.candidates.iter().flat_map(open).collect();
    let effects: Vec<f64> = vec![0.0; best.shift.len()].into_iter().chain(changes).collect();
    let found = unexplained(workspace, expected, &parameters, &effects, clean)?;
    if clean.is_none() || found.is_empty() {
        return Ok(found);
    }
    // Coefficients that gave way to what is missing have spread it over the trial: it is dated by
    // those of clean trials.
    let given_way = search.given_way().into_iter().map(|change| -change);
    let as_calibrated: Vec<f64> =
        given_way.chain(parameters.iter().copied().skip(best.shift.len())).collect();
    let dated = unexplained(workspace, expected, &as_calibrated, &effects, clean)?;
    let same = |a: &Unexplained, b: &Unexplained| a.trial == b.trial && a.channel == b.channel;
    let dated: Vec<Unexplained> =
        dated.into_iter().filter(|a| found.iter().any(|b| same(a, b))).collect();
    Ok(if dated.is_empty() { found } else { dated })
}
