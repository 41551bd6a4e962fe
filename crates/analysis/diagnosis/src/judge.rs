//! Errors before and after the diagnosis, on trials that the fit of the effects has not seen.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::{Model, Trial};
use sistership_simulation::error::SquaredError;
use sistership_simulation::metrics::{ManoeuvreMetrics, ManoeuvreRecognition, recorded_track};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use super::DiagnosisInputs;
use super::outcome::{ManoeuvreOutcome, TrialErrors};
use super::refit::RefittedModel;
use sistership_priors::transfer::prepare_ship;

/// Errors and manoeuvres of all trials.
pub(super) struct SimulatedErrors {
    pub before: BTreeMap<String, f64>,
    pub after: BTreeMap<String, f64>,
    pub trials: Vec<TrialErrors>,
    pub manoeuvres: Vec<ManoeuvreOutcome>,
    /// Index of the refit that is best on all trials.
    pub taken: usize,
    /// Mean over channels of the logarithm of the errors' ratio, after by before.
    pub change: f64,
}

/// Errors of each trial; none where the simulation stopped.
type TrialSquaredErrors = Vec<Option<SquaredError>>;

/// Simulates each trial by the given model, and by a model fitted on the others with the refit that
/// is best on the others. A fit by trajectories holds a trial out by one step from the fit on all
/// of them.
pub(super) fn simulate_errors(
    request: &DiagnosisInputs<'_>,
    refits: &[RefittedModel],
    restart_s: f64,
) -> SimulatedErrors {
    let count = request.trials.len();
    let before = errors_per_trial(request, &vec![request.model; count], restart_s);
    let each: Vec<TrialSquaredErrors> = refits
        .iter()
        .map(|refit| {
            errors_per_trial(request, &refit.without.iter().collect::<Vec<_>>(), restart_s)
        })
        .collect();
    // The refit of a trial is chosen on the other trials, so that the choice is held out too.
    let best = |keep: &dyn Fn(usize) -> bool| {
        let changes = each.iter().map(|after| mean_log_ratio(&before, after, keep)).enumerate();
        changes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(place, _)| place)
    };
    let ways: Vec<usize> =
        (0..count).map(|trial| best(&|other| other != trial || count == 1)).collect();
    let after: TrialSquaredErrors =
        ways.iter().enumerate().map(|(trial, &way)| each[way][trial].clone()).collect();
    let model = |trial: usize| &refits[ways[trial]].without[trial];
    SimulatedErrors {
        before: channel_rmse(&before, &|_| true),
        after: channel_rmse(&after, &|_| true),
        trials: (0..count)
            .map(|trial| trial_errors(request.trials[trial], &before[trial], &after[trial]))
            .collect(),
        manoeuvres: (0..count)
            .filter_map(|trial| compare_manoeuvre(request, model(trial), request.trials[trial]))
            .collect(),
        taken: best(&|_| true),
        change: mean_log_ratio(&before, &after, &|_| true),
    }
}

fn errors_per_trial(
    request: &DiagnosisInputs<'_>,
    models: &[&Model],
    restart_s: f64,
) -> TrialSquaredErrors {
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let one = |(model, trial): (&&Model, &&Trial)| {
        // A simulation that stopped early has no error.
        let ship = prepare_ship(model, request.law, &[trial]).ok()?;
        let run = replay_trial(&ship, trial, &settings).ok().filter(|run| run.stopped.is_none())?;
        Some(SquaredError::from_trial(trial, &run))
    };
    models.par_iter().zip(request.trials).map(one).collect()
}

fn channel_rmse(each: &TrialSquaredErrors, keep: &dyn Fn(usize) -> bool) -> BTreeMap<String, f64> {
    let mut sum = SquaredError::default();
    let kept = each
        .iter()
        .enumerate()
        .filter(|(trial, _)| keep(*trial))
        .filter_map(|(_, error)| error.as_ref());
    kept.for_each(|error| sum.add(error));
    sum.rmse_by_channel()
}

/// Mean over channels of the logarithm of the ratio over some trials; infinite where a simulation
/// stops that did not before.
fn mean_log_ratio(
    before: &TrialSquaredErrors,
    after: &TrialSquaredErrors,
    keep: &dyn Fn(usize) -> bool,
) -> f64 {
    let stops = |trial: usize| keep(trial) && before[trial].is_some() && after[trial].is_none();
    if (0..before.len()).any(stops) {
        return f64::INFINITY;
    }
    let (before, after) = (channel_rmse(before, keep), channel_rmse(after, keep));
    // A channel without error has no logarithm and is omitted.
    let logs =
        before.iter().filter_map(|(channel, before)| Some((after.get(channel)? / before).ln()));
    let logs: Vec<f64> = logs.filter(|log| log.is_finite()).collect();
    if logs.is_empty() { 0.0 } else { logs.iter().sum::<f64>() / logs.len() as f64 }
}

fn trial_errors(
    trial: &Trial,
    before: &Option<SquaredError>,
    after: &Option<SquaredError>,
) -> TrialErrors {
    let rmse = |error: &Option<SquaredError>| {
        error.as_ref().map(SquaredError::rmse_by_channel).unwrap_or_default()
    };
    TrialErrors { trial: trial.name.clone(), before: rmse(before), after: rmse(after) }
}

fn compare_manoeuvre(
    request: &DiagnosisInputs<'_>,
    after: &Model,
    trial: &Trial,
) -> Option<ManoeuvreOutcome> {
    // Trials that are no standard manoeuvre are not compared.
    let recognised = ManoeuvreRecognition::from_trial(trial)?;
    let simulated = |model: &Model| -> Option<ManoeuvreMetrics> {
        let ship = prepare_ship(model, request.law, &[trial]).ok()?;
        let run = replay_trial(&ship, trial, &ReplaySettings::default())
            .ok()
            .filter(|run| run.stopped.is_none())?;
        recognised.track_metrics(&run.track, &run.samples)
    };
    let samples: Vec<usize> = (0..trial.len()).collect();
    let measured = recognised.track_metrics(&recorded_track(trial)?, &samples)?;
    Some(ManoeuvreOutcome {
        trial: trial.name.clone(),
        measured,
        before: simulated(request.model),
        after: simulated(after),
    })
}
