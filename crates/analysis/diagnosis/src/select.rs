//! Selection of the final effects: those that are constant in time, or none where changes within
//! trials explain everything.

use super::DiagnosisInputs;
use super::changes::{find_changes, trials_with_remainder};
use super::choose::{ConvergedChoice, EffectChoice, choose_effects};
use super::constancy::inconstant_effects;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use super::misfit::shape_error;
use super::outcome::{EffectChange, UnexplainedSegment};
use super::refusal::Refusal;
use super::remainder::find_unexplained;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{AxisDiscrepancies, EffectCandidate};
use sistership_identification::refine::{Progress, RefineError};

/// Final selection.
pub(super) struct SelectedEffects<'a> {
    pub choice: EffectChoice,
    pub settled: ConvergedChoice<'a>,
    pub remaining: Vec<UnexplainedSegment>,
    pub changes: Vec<EffectChange>,
    /// Names of effects that are not constant in time.
    pub refused: Vec<String>,
}

/// Selects the effects that are constant in time, where something remains unexplained. Where one is
/// not, the search is repeated without it, as it may have displaced another. Before that, changes
/// within trials as the only cause are considered, since a repeated search takes as long as all
/// steps before. `base` is that of the first search without effects.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn select_effects<'a>(
    request: &DiagnosisInputs<'_>,
    (first, base): (&HypothesisSearch<'a>, &FilteredBase<'a>),
    mut choice: EffectChoice,
    progress: Progress<'_>,
) -> Result<SelectedEffects<'a>, RefineError> {
    let (mut search, mut refused) = (first.clone(), Vec::new());
    loop {
        let state = RemainderState::from_converged(choice.converge(&search, request)?)?;
        let varying = state.inconstant_places(request.settings.least_evidence)?;
        let is_asked = refused.is_empty() || varying.is_empty();
        if is_asked && !state.remaining.is_empty() && !state.accepted_effects().is_empty() {
            report_progress(progress, "comparing with changes within trials")?;
            let steady = state.effect_names(|place| !varying.contains(&place));
            // All accepted effects only resembled the changes.
            if let Some((state, changes)) = only_changes(request, first, &choice, &steady)? {
                refused.extend(
                    choice.best_hypothesis().candidates.iter().map(|one| one.effect.clone()),
                );
                choice.taken = None;
                return Ok(state.into_selection(choice, changes, refused));
            }
        }
        if varying.is_empty() {
            report_progress(progress, "finding changes within trials")?;
            let changes = state.find_changes(request, first)?;
            return Ok(state.into_selection(choice, changes, refused));
        }
        // What remains of the others is looked for among effects that are constant by themselves:
        // one that only resembles the missing effect would be refused after the next search.
        let steady = state.effect_names(|place| !varying.contains(&place));
        search.steady.get_or_insert_default().extend(steady);
        // Refused effects are removed from the search before it is repeated.
        let names = state.effect_names(|place| varying.contains(&place)).into_iter();
        refused.extend(names.inspect(|name| search.remove_effect(name)));
        if let Some(name) = refused.last() {
            choice.refuse_accepted(Refusal::NotConstant(name.clone()));
        }
        report_progress(progress, "removing effects with inconsistent sizes")?;
        choice = choose_effects(&search, base, request.settings)?.merge_earlier(choice);
    }
}

/// Converged effects and coefficients, with their remainder.
struct RemainderState<'a> {
    settled: ConvergedChoice<'a>,
    remaining: Vec<UnexplainedSegment>,
}

impl<'a> RemainderState<'a> {
    fn from_converged(settled: ConvergedChoice<'a>) -> Result<Self, RefineError> {
        let remaining =
            unexplained_segments(&settled.search, &settled.best, &settled.base.workspace)?;
        Ok(Self { settled, remaining })
    }

    fn accepted_effects(&self) -> &[EffectCandidate] {
        &self.settled.best.candidates
    }

    fn effect_names(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<String> {
        let wanted =
            self.accepted_effects().iter().enumerate().filter(|(place, _)| is_wanted(*place));
        wanted.map(|(_, candidate)| candidate.effect.clone()).collect()
    }

    /// Indices of the effects that are not constant in time, where something remains unexplained.
    fn inconstant_places(&self, margin: f64) -> Result<Vec<usize>, RefineError> {
        let ConvergedChoice { search, base, best, .. } = &self.settled;
        match self.remaining.is_empty() {
            true => Ok(Vec::new()),
            false => inconstant_effects(search, base, best, margin),
        }
    }

    /// Changes within trials in addition to the accepted effects.
    fn find_changes(
        &self,
        request: &DiagnosisInputs<'_>,
        first: &HypothesisSearch<'_>,
    ) -> Result<Vec<EffectChange>, RefineError> {
        let all = (&self.settled.search, &self.settled.best, first.listed.as_slice());
        find_changes(all, &self.remaining, request.settings.least_evidence)
    }

    /// Completes the selection; an effect that changes is not listed as one that only resembles the
    /// missing one.
    fn into_selection(
        self,
        choice: EffectChoice,
        changes: Vec<EffectChange>,
        mut refused: Vec<String>,
    ) -> SelectedEffects<'a> {
        refused.retain(|name| changes.iter().all(|change| change.effect != *name));
        let Self { settled, remaining } = self;
        SelectedEffects { choice, settled, remaining, changes, refused }
    }
}

fn report_progress(progress: Progress<'_>, what: &str) -> Result<(), RefineError> {
    if progress(0.8, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// Returns the model without effects, if its remainder consists only of changes of one effect, with
/// more evidence than the accepted effects: these only resembled the changes. An effect that is
/// `steady` is no change.
fn only_changes<'a>(
    request: &DiagnosisInputs<'_>,
    first: &HypothesisSearch<'a>,
    choice: &EffectChoice,
    steady: &[String],
) -> Result<Option<(RemainderState<'a>, Vec<EffectChange>)>, RefineError> {
    let state = RemainderState::from_converged(choice.converge_alone(first, request)?)?;
    // No more trials than that are examined for changes: the others would stay unexplained.
    if trials_with_remainder(&state.remaining).len() > THRESHOLDS.changes.asked {
        return Ok(None);
    }
    let changes = state.find_changes(request, first)?;
    let is_told =
        |open: &UnexplainedSegment| changes.iter().any(|change| change.trial == open.trial);
    let is_steady = changes.iter().any(|change| steady.contains(&change.effect));
    let evidence: f64 = changes.iter().map(|change| change.evidence).sum();
    let of_effects = choice.best_hypothesis().log_evidence - choice.alone.log_evidence;
    let is_all = !is_steady && state.remaining.iter().all(is_told) && evidence > of_effects;
    Ok(is_all.then_some((state, changes)))
}

/// Discrepancy by which the remainder is judged.
pub(super) fn remainder_discrepancies(
    search: &HypothesisSearch<'_>,
    workspace: &LinearisedTrials<'_>,
) -> AxisDiscrepancies {
    match search.model.uncertainty {
        Some(_) => search.expected.clone(),
        None => {
            workspace.motion_scales().level_discrepancies(THRESHOLDS.discrepancy.remainder_level)
        }
    }
}

/// Change of each column.
pub(super) fn column_changes(best: &JudgedHypothesis) -> Vec<f64> {
    best.shift.iter().copied().chain(best.parameter_changes()).collect()
}

fn unexplained_segments(
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
    workspace: &LinearisedTrials<'_>,
) -> Result<Vec<UnexplainedSegment>, RefineError> {
    let (expected, parameters) =
        (&remainder_discrepancies(search, workspace), column_changes(best));
    let clean = search.model.uncertainty.as_ref().map(|uncertainty| &uncertainty.remainder);
    let open = |candidate: &EffectCandidate| {
        let share = shape_error(candidate);
        candidate.parameter_changes().into_iter().map(move |change| share * change)
    };
    let changes: Vec<f64> = best.candidates.iter().flat_map(open).collect();
    let effects: Vec<f64> = vec![0.0; best.shift.len()].into_iter().chain(changes).collect();
    let found = find_unexplained(workspace, expected, &parameters, &effects, clean)?;
    // Without a calibration there are no coefficients of clean trials to date the remainder by.
    if clean.is_none() || found.is_empty() {
        return Ok(found);
    }
    // Coefficients that were shifted by the missing effect have spread it over the trial: its time
    // is determined with those of clean trials.
    let given_way = search.coefficient_shift().into_iter().map(|change| -change);
    let as_calibrated: Vec<f64> =
        given_way.chain(parameters.iter().copied().skip(best.shift.len())).collect();
    let dated = find_unexplained(workspace, expected, &as_calibrated, &effects, clean)?;
    let same = |a: &UnexplainedSegment, b: &UnexplainedSegment| {
        a.trial == b.trial && a.channel == b.channel
    };
    let dated: Vec<UnexplainedSegment> =
        dated.into_iter().filter(|a| found.iter().any(|b| same(a, b))).collect();
    Ok(if dated.is_empty() { found } else { dated })
}
