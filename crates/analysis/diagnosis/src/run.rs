//! Steps of a diagnosis.

use std::collections::BTreeMap;

use super::DiagnosisInputs;
use super::choose::{ConvergedChoice, choose_effects};
use super::continued_history::{continue_history, history_before};
use super::dependence::remainder_dependence;
use super::findings::{
    collect_remarks, describe_method, found_with_confounded, pattern_remark, refitted_parameters,
    report_hypotheses,
};
use super::hidden_patterns::{pattern_origin, pattern_segments, remainder_patterns};
use super::judge::{SimulatedErrors, simulate_errors};
use super::limits::{excluding, undetectable_effects};
use super::linearised_trials::LinearisedTrials;
use super::origin::remainder_origins;
use super::outcome::{Diagnosis, MissingEffect, NextTrial, UnexplainedSegment, Verdict};
use super::refit::{RefittedModel, refit_alternatives};
use super::search::HypothesisSearch;
use super::select::{SelectedEffects, select_effects};
use super::series::{discrepancy_levels, residual_series};
use super::settings::Settings;
use super::setup::{prepare_search, with_level_below};
use super::thresholds::THRESHOLDS;
use sistership_filtering::NoiseLevel;
use sistership_identification::refine::{Progress, RefineError};
use sistership_model::Model;
use sistership_model::trial::Channel;

/// Diagnoses a model on trials that have been checked.
///
/// # Errors
/// Returns an error that names the trial or channel at fault, or one if `progress` cancels.
pub(super) fn diagnose_trials(
    request: &DiagnosisInputs<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    report_progress(progress, 0.05, "selecting the effects that these trials can show")?;
    let mut search = with_level_below(prepare_search(request)?);
    report_progress(progress, 0.1, "evaluating effects, alone and in combination")?;
    let base = search.filter_with_candidates(&[], &search.levels)?;
    let least = request.settings.least_evidence;
    search.history = history_before(&search, (&base, search.judge_base(&base)?.0), least)?;
    let choice = choose_effects(&search, &base, request.settings)?;
    report_progress(progress, 0.8, "analysing the residual")?;
    let selected = select_effects(request, (&search, &base), choice, progress)?;
    let best = &selected.settled.best;
    let named: Vec<String> = best.candidates.iter().map(|one| one.effect.clone()).collect();
    let level = best.level.min(base.levels.len() - 1);
    let history = continue_history(&search, (&base, level), &named, least)?;
    // The filtered columns are large, and are not needed any more.
    drop(base);
    let diagnosis = assemble_answer(request, &search, selected, progress)?;
    // Where something is unexplained the information is not on these effects: a later trial without
    // it would be judged by what they stood in for.
    let is_explained = diagnosis.verdict != Verdict::Unexplained;
    Ok(Diagnosis { history: is_explained.then_some(history), ..diagnosis })
}

fn report_progress(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

fn assemble_answer(
    request: &DiagnosisInputs<'_>,
    first: &HypothesisSearch<'_>,
    selected: SelectedEffects<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    report_progress(progress, 0.85, "cross-validating the result")?;
    let fitted = fit_and_simulate(request, &selected.settled)?;
    report_progress(progress, 0.95, "finding effects that these trials cannot distinguish")?;
    let named = name_effects(request, &selected, &fitted)?;
    build_diagnosis(request, first, selected, (fitted, named))
}

/// The model with the effects found, and its errors.
struct FittedModel {
    errors: SimulatedErrors,
    taken: RefittedModel,
}

fn fit_and_simulate(
    request: &DiagnosisInputs<'_>,
    settled: &ConvergedChoice<'_>,
) -> Result<FittedModel, RefineError> {
    let ConvergedChoice { search, base, best, .. } = settled;
    let length_s = base.workspace.lpp_m / base.workspace.speed_m_s;
    let restart_s = request.settings.restart_s.unwrap_or(THRESHOLDS.trials.restart * length_s);
    let mut refits = refit_alternatives(request, search, best, restart_s)?;
    let errors = simulate_errors(request, &refits, restart_s);
    let taken = refits.swap_remove(errors.taken);
    Ok(FittedModel { errors, taken })
}

/// Named effects, with the resulting model and remarks.
struct NamedEffects {
    found: Vec<MissingEffect>,
    next_trial: Option<NextTrial>,
    /// The model with them, where it simulates better.
    model: Option<Model>,
    remarks: Vec<String>,
}

fn name_effects(
    request: &DiagnosisInputs<'_>,
    selected: &SelectedEffects<'_>,
    fitted: &FittedModel,
) -> Result<NamedEffects, RefineError> {
    let SelectedEffects { choice, settled, refused, .. } = selected;
    let of_all = choice.best_hypothesis().log_evidence - choice.alone.log_evidence;
    let (mut found, next_trial) =
        found_with_confounded(request, &settled.search, &settled.best, of_all)?;
    // A model is given only if held-out errors decrease.
    let is_better = !found.is_empty() && fitted.errors.change < 0.0;
    let model = is_better.then(|| fitted.taken.all.clone());
    found.iter_mut().for_each(|found| {
        found.in_model =
            model.as_ref().map_or_else(BTreeMap::new, |model| refitted_parameters(found, model))
    });
    let remarks = collect_remarks(refused, found.is_empty() || model.is_some(), &found);
    Ok(NamedEffects { found, next_trial, model, remarks })
}

fn derive_verdict(remaining: &[UnexplainedSegment], found: &[MissingEffect]) -> Verdict {
    match (remaining.is_empty(), found.is_empty()) {
        (false, _) => Verdict::Unexplained,
        (true, true) => Verdict::Complete,
        (true, false) => Verdict::Effects,
    }
}

/// Assembles the result.
fn build_diagnosis(
    request: &DiagnosisInputs<'_>,
    first: &HypothesisSearch<'_>,
    selected: SelectedEffects<'_>,
    (fitted, named): (FittedModel, NamedEffects),
) -> Result<Diagnosis, RefineError> {
    let SelectedEffects { choice, settled, remaining, changes, .. } = selected;
    let ConvergedChoice { search, base, best, .. } = &settled;
    let names: Vec<String> = named.found.iter().map(|found| found.name.clone()).collect();
    let limits = excluding(choice.limits.clone(), &names);
    let FittedModel { errors, taken } = fitted;
    let residuals = residual_series(first, search, best)?;
    let least_evidence = request.settings.least_evidence;
    // Where a segment stands out already, what it depends on is found by its residual.
    let patterns = match remaining.is_empty() {
        true => remainder_patterns(&settled, least_evidence)?,
        false => Vec::new(),
    };
    let (remaining, origins) = match patterns.first() {
        Some(first) => {
            (pattern_segments(&settled, first)?, vec![pattern_origin(first, request.trials.len())])
        }
        None => {
            let origins = remainder_origins(&settled, &remaining, least_evidence)?;
            (remaining, origins)
        }
    };
    Ok(Diagnosis {
        verdict: derive_verdict(&remaining, &named.found),
        remarks: named.remarks.into_iter().chain(patterns.first().map(pattern_remark)).collect(),
        patterns,
        history: None,
        changes,
        depends_on: remainder_dependence(first.trials, &residuals, (&remaining, &origins)),
        origins,
        effects: named.found,
        unexplained: remaining,
        cannot_tell: undetectable_effects(&limits),
        limits,
        prior_odds: if first.states_odds { first.prior_odds() } else { BTreeMap::new() },
        next_trial: named.next_trial,
        before: errors.before,
        after: errors.after,
        noise: noise_by_channel(&base.workspace),
        how: describe_method(request, taken.how.as_deref()),
        diagnosed: request.model.name.clone(),
        hypotheses: report_hypotheses(request, &settled, &choice)?,
        trials: errors.trials,
        manoeuvres: errors.manoeuvres,
        residuals,
        discrepancies: discrepancy_levels(search, &base.workspace, &choice.alone, best),
        model: named.model,
        // Earlier trials are part of the history.
        settings: Settings { earlier: None, ..request.settings.clone() },
    })
}

/// Noise of the instruments, by channel, SI.
fn noise_by_channel(workspace: &LinearisedTrials<'_>) -> BTreeMap<String, f64> {
    let one = |(channel, instrument): (&Channel, &NoiseLevel)| {
        (channel.name().to_owned(), instrument.deviation)
    };
    workspace.noise.iter().map(one).collect()
}
