//! Steps of a diagnosis.

use std::collections::BTreeMap;

use super::Request;
use super::choose::{ConvergedChoice, choose};
use super::dependence::of_remainder;
use super::judge::{SimulatedErrors, errors};
use super::limits::{but, cannot_tell};
use super::linearised_trials::LinearisedTrials;
use super::origin::origins;
use super::outcome::{Diagnosis, Found, NextTrial, Unexplained, Verdict};
use super::refit::{Refit, refits};
use super::said::{apart, how, hypotheses, in_model, remarks};
use super::search::HypothesisSearch;
use super::select::{SelectedEffects, selected};
use super::series::{levels, residuals};
use super::setup::{search, with_level_below};
use super::thresholds::THRESHOLDS;
use sistership_filtering::Instrument;
use sistership_identification::refine::{Progress, RefineError};
use sistership_model::Model;
use sistership_model::trial::Channel;

/// Diagnoses a model on trials.
///
/// # Errors
/// Returns an error that names the setting, trial or channel at fault, or one if `progress`
/// cancels.
pub fn diagnose(request: &Request<'_>, progress: Progress<'_>) -> Result<Diagnosis, RefineError> {
    request.settings.check().map_err(|(field, message)| RefineError::Setting { field, message })?;
    if request.trials.is_empty() {
        return Err(RefineError::Data("there is no trial to diagnose on".into()));
    }
    step(progress, 0.05, "which effects can be tried on these trials")?;
    let search = with_level_below(search(request)?);
    step(progress, 0.1, "every effect alone, then together")?;
    let base = search.base(&[], &search.levels)?;
    let choice = choose(&search, &base, request.settings)?;
    step(progress, 0.8, "what remains")?;
    let selected = selected(request, (&search, &base), choice, progress)?;
    // The filtered columns are large, and are not needed any more.
    drop(base);
    answer(request, &search, selected, progress)
}

fn step(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

fn answer(
    request: &Request<'_>,
    first: &HypothesisSearch<'_>,
    selected: SelectedEffects<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    step(progress, 0.85, "simulating each trial by a fit on the others")?;
    let fitted = fitted(request, &selected.settled)?;
    step(progress, 0.95, "what these trials cannot tell apart")?;
    let named = named(request, &selected, &fitted)?;
    written(request, first, selected, (fitted, named))
}

/// The model with the effects found, and its errors.
struct FittedModel {
    errors: SimulatedErrors,
    taken: Refit,
}

fn fitted(
    request: &Request<'_>,
    settled: &ConvergedChoice<'_>,
) -> Result<FittedModel, RefineError> {
    let ConvergedChoice { search, base, best } = settled;
    let length_s = base.workspace.lpp_m / base.workspace.speed_m_s;
    let restart_s = request.settings.restart_s.unwrap_or(THRESHOLDS.trials.restart * length_s);
    let mut refits = refits(request, search, best, restart_s)?;
    let errors = errors(request, &refits, restart_s);
    let taken = refits.swap_remove(errors.taken);
    Ok(FittedModel { errors, taken })
}

/// Named effects, with the resulting model and remarks.
struct NamedEffects {
    found: Vec<Found>,
    next_trial: Option<NextTrial>,
    /// The model with them, where it simulates better.
    model: Option<Model>,
    remarks: Vec<String>,
}

fn named(
    request: &Request<'_>,
    selected: &SelectedEffects<'_>,
    fitted: &FittedModel,
) -> Result<NamedEffects, RefineError> {
    let SelectedEffects { choice, settled, refused, .. } = selected;
    let of_all = choice.best().log_evidence - choice.alone.log_evidence;
    let (mut found, next_trial) = apart(request, &settled.search, &settled.best, of_all)?;
    // A model is given only if held-out errors decrease.
    let is_better = !found.is_empty() && fitted.errors.change < 0.0;
    let model = is_better.then(|| fitted.taken.all.clone());
    found.iter_mut().for_each(|found| {
        found.in_model = model.as_ref().map_or_else(BTreeMap::new, |model| in_model(found, model))
    });
    let remarks = remarks(refused, found.is_empty() || model.is_some(), &found);
    Ok(NamedEffects { found, next_trial, model, remarks })
}

fn verdict(remaining: &[Unexplained], found: &[Found]) -> Verdict {
    match (remaining.is_empty(), found.is_empty()) {
        (false, _) => Verdict::Unexplained,
        (true, true) => Verdict::Complete,
        (true, false) => Verdict::Effects,
    }
}

/// Assembles the result.
fn written(
    request: &Request<'_>,
    first: &HypothesisSearch<'_>,
    selected: SelectedEffects<'_>,
    (fitted, named): (FittedModel, NamedEffects),
) -> Result<Diagnosis, RefineError> {
    let SelectedEffects { choice, settled, remaining, changes, .. } = selected;
    let ConvergedChoice { search, base, best } = &settled;
    let names: Vec<String> = named.found.iter().map(|found| found.name.clone()).collect();
    let limits = but(choice.limits.clone(), &names);
    let FittedModel { errors, taken } = fitted;
    let residuals = residuals(first, search, best)?;
    let origins = origins(&settled, &remaining, request.settings.least_evidence)?;
    Ok(Diagnosis {
        verdict: verdict(&remaining, &named.found),
        changes,
        depends_on: of_remainder(first.trials, &residuals, (&remaining, &origins)),
        origins,
        effects: named.found,
        unexplained: remaining,
        cannot_tell: cannot_tell(&limits),
        limits,
        prior_odds: if first.states_odds { first.prior_odds() } else { BTreeMap::new() },
        next_trial: named.next_trial,
        before: errors.before,
        after: errors.after,
        noise: deviations(&base.workspace),
        how: how(request, taken.how.as_deref()),
        diagnosed: request.model.name.clone(),
        hypotheses: hypotheses(request, search, &choice)?,
        trials: errors.trials,
        manoeuvres: errors.manoeuvres,
        residuals,
        discrepancies: levels(search, &base.workspace, &choice.alone, best),
        model: named.model,
        settings: request.settings.clone(),
        remarks: named.remarks,
    })
}

/// Noise of the instruments, by channel, SI.
fn deviations(workspace: &LinearisedTrials<'_>) -> BTreeMap<String, f64> {
    let one = |(channel, instrument): (&Channel, &Instrument)| {
        (channel.name().to_owned(), instrument.deviation)
    };
    workspace.noise.iter().map(one).collect()
}
