//! Errors before and after, on trials that the fit of the effects has not seen.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_dynamics::error::SquaredError;
use sistership_dynamics::metrics::{ManoeuvreMetrics, Recognised, recorded_track};
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_model::{Model, Trial};

use super::Request;
use super::outcome::{SailedManoeuvre, TrialErrors};
use super::refit::{STRENGTHS, refitted};
use super::search::{Judged, Search};
use crate::transfer::ready;

/// Errors and manoeuvres of all trials.
pub(super) struct Errors {
    pub before: BTreeMap<String, f64>,
    pub after: BTreeMap<String, f64>,
    pub trials: Vec<TrialErrors>,
    pub manoeuvres: Vec<SailedManoeuvre>,
    /// Strength of the prior by which coefficients were refitted; none where they stay.
    pub strength: Option<f64>,
    /// Mean over channels of the logarithm of the errors' ratio, after by before.
    pub change: f64,
}

/// Errors of each trial; none where the simulation stopped.
type Each = Vec<Option<SquaredError>>;

/// Simulates each trial by the model as it is, and by the model with the effects and coefficients fitted on the others.
pub(super) fn errors(request: &Request<'_>, search: &Search<'_>, judged: &Judged, restart_s: f64) -> Errors {
    let models: Vec<Model> = (0..request.trials.len()).map(|trial| without(request, search, judged, trial)).collect();
    let before = simulated(request, &vec![request.model; models.len()], restart_s);
    let strengths = if judged.candidates.is_empty() { &STRENGTHS[..1] } else { &STRENGTHS[..] };
    let tried = strengths.iter().map(|&strength| {
        let fitted: Vec<Model> = (0..models.len()).map(|trial| fitted(request, &models[trial], trial, strength)).collect();
        let after = simulated(request, &fitted.iter().collect::<Vec<_>>(), restart_s);
        (change(&before, &after), strength, fitted, after)
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
    let (change, strength, fitted, after) = best.unwrap_or_else(|| (0.0, None, models.clone(), before.clone()));
    Errors {
        before: total(&before),
        after: total(&after),
        trials: (0..before.len()).map(|trial| of_trial(request.trials[trial], &before[trial], &after[trial])).collect(),
        manoeuvres: fitted.iter().zip(request.trials).filter_map(|(model, trial)| manoeuvre(request, model, trial)).collect(),
        strength,
        change,
    }
}

/// The trials but one; of a single one, itself.
fn others<'a>(request: &Request<'a>, but: usize) -> Vec<&'a Trial> {
    let count = request.trials.len();
    (0..count).filter(|&other| other != but || count == 1).map(|other| request.trials[other]).collect()
}

/// The model with effects as the other trials ask for them.
fn without(request: &Request<'_>, search: &Search<'_>, judged: &Judged, trial: usize) -> Model {
    let keep = |other: usize| other != trial || request.trials.len() == 1;
    let fitted = judged.of_trials(&search.fixed, &keep).filter(|(_, candidates)| !candidates.is_empty());
    fitted.map_or_else(|| request.model.clone(), |(_, candidates)| search.model_with(&candidates, None))
}

fn fitted(request: &Request<'_>, model: &Model, trial: usize, strength: Option<f64>) -> Model {
    refitted(model, request.law, &others(request, trial), strength).into_owned()
}

fn simulated(request: &Request<'_>, models: &[&Model], restart_s: f64) -> Each {
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let one = |(model, trial): (&&Model, &&Trial)| {
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &settings).ok().filter(|run| run.stopped.is_none())?;
        Some(SquaredError::of(trial, &run))
    };
    models.par_iter().zip(request.trials).map(one).collect()
}

fn total(each: &Each) -> BTreeMap<String, f64> {
    let mut sum = SquaredError::default();
    each.iter().flatten().for_each(|error| sum.add(error));
    sum.rmse()
}

/// Mean over channels of the logarithm of the ratio; infinite where a simulation stops that did not before.
fn change(before: &Each, after: &Each) -> f64 {
    if before.iter().zip(after).any(|(before, after)| before.is_some() && after.is_none()) {
        return f64::INFINITY;
    }
    let (before, after) = (total(before), total(after));
    let logs: Vec<f64> = before.iter().filter_map(|(channel, before)| Some((after.get(channel)? / before).ln())).collect();
    let logs: Vec<f64> = logs.into_iter().filter(|log| log.is_finite()).collect();
    if logs.is_empty() { 0.0 } else { logs.iter().sum::<f64>() / logs.len() as f64 }
}

fn of_trial(trial: &Trial, before: &Option<SquaredError>, after: &Option<SquaredError>) -> TrialErrors {
    let rmse = |error: &Option<SquaredError>| error.as_ref().map(SquaredError::rmse).unwrap_or_default();
    TrialErrors { trial: trial.name.clone(), before: rmse(before), after: rmse(after) }
}

fn manoeuvre(request: &Request<'_>, after: &Model, trial: &Trial) -> Option<SailedManoeuvre> {
    let recognised = Recognised::of(trial)?;
    let simulated = |model: &Model| -> Option<ManoeuvreMetrics> {
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &ReplaySettings::default()).ok().filter(|run| run.stopped.is_none())?;
        recognised.metrics(&run.track, &run.samples)
    };
    let samples: Vec<usize> = (0..trial.len()).collect();
    let measured = recognised.metrics(&recorded_track(trial)?, &samples)?;
    Some(SailedManoeuvre { trial: trial.name.clone(), measured, before: simulated(request.model), after: simulated(after) })
}
