//! Errors before and after the diagnosis, on trials that the fit of the effects has not seen.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::{Model, Trial};
use sistership_simulation::error::SquaredError;
use sistership_simulation::metrics::{ManoeuvreMetrics, Recognised, recorded_track};
use sistership_simulation::recorded::{ReplaySettings, replay};

use super::Request;
use super::outcome::{SailedManoeuvre, TrialErrors};
use super::refit::Refit;
use sistership_priors::transfer::ready;

/// Errors and manoeuvres of all trials.
pub(super) struct SimulatedErrors {
    pub before: BTreeMap<String, f64>,
    pub after: BTreeMap<String, f64>,
    pub trials: Vec<TrialErrors>,
    pub manoeuvres: Vec<SailedManoeuvre>,
    /// Index of the refit that is best on all trials.
    pub taken: usize,
    /// Mean over channels of the logarithm of the errors' ratio, after by before.
    pub change: f64,
}

/// Errors of each trial; none where the simulation stopped.
type Each = Vec<Option<SquaredError>>;

/// Simulates each trial by the given model, and by a model fitted on the others with the refit that
/// is best on the others. A fit by trajectories holds a trial out by one step from the fit on all
/// of them.
pub(super) fn errors(request: &Request<'_>, refits: &[Refit], restart_s: f64) -> SimulatedErrors {
    let count = request.trials.len();
    let before = simulated(request, &vec![request.model; count], restart_s);
    let each: Vec<Each> = refits
        .iter()
        .map(|refit| simulated(request, &refit.without.iter().collect::<Vec<_>>(), restart_s))
        .collect();
    // The refit of a trial is chosen on the other trials, so that the choice is held out too.
    let best = |keep: &dyn Fn(usize) -> bool| {
        let changes = each.iter().map(|after| change(&before, after, keep)).enumerate();
        changes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(place, _)| place)
    };
    let ways: Vec<usize> =
        (0..count).map(|trial| best(&|other| other != trial || count == 1)).collect();
    let after: Each =
        ways.iter().enumerate().map(|(trial, &way)| each[way][trial].clone()).collect();
    let model = |trial: usize| &refits[ways[trial]].without[trial];
    SimulatedErrors {
        before: total(&before, &|_| true),
        after: total(&after, &|_| true),
        trials: (0..count)
            .map(|trial| of_trial(request.trials[trial], &before[trial], &after[trial]))
            .collect(),
        manoeuvres: (0..count)
            .filter_map(|trial| manoeuvre(request, model(trial), request.trials[trial]))
            .collect(),
        taken: best(&|_| true),
        change: change(&before, &after, &|_| true),
    }
}

fn simulated(request: &Request<'_>, models: &[&Model], restart_s: f64) -> Each {
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let one = |(model, trial): (&&Model, &&Trial)| {
        // A simulation that stopped early has no error.
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &settings).ok().filter(|run| run.stopped.is_none())?;
        Some(SquaredError::of(trial, &run))
    };
    models.par_iter().zip(request.trials).map(one).collect()
}

fn total(each: &Each, keep: &dyn Fn(usize) -> bool) -> BTreeMap<String, f64> {
    let mut sum = SquaredError::default();
    let kept = each
        .iter()
        .enumerate()
        .filter(|(trial, _)| keep(*trial))
        .filter_map(|(_, error)| error.as_ref());
    kept.for_each(|error| sum.add(error));
    sum.rmse()
}

/// Mean over channels of the logarithm of the ratio over some trials; infinite where a simulation
/// stops that did not before.
fn change(before: &Each, after: &Each, keep: &dyn Fn(usize) -> bool) -> f64 {
    let stops = |trial: usize| keep(trial) && before[trial].is_some() && after[trial].is_none();
    if (0..before.len()).any(stops) {
        return f64::INFINITY;
    }
    let (before, after) = (total(before, keep), total(after, keep));
    // A channel without error has no logarithm and is omitted.
    let logs =
        before.iter().filter_map(|(channel, before)| Some((after.get(channel)? / before).ln()));
    let logs: Vec<f64> = logs.filter(|log| log.is_finite()).collect();
    if logs.is_empty() { 0.0 } else { logs.iter().sum::<f64>() / logs.len() as f64 }
}

fn of_trial(
    trial: &Trial,
    before: &Option<SquaredError>,
    after: &Option<SquaredError>,
) -> TrialErrors {
    let rmse =
        |error: &Option<SquaredError>| error.as_ref().map(SquaredError::rmse).unwrap_or_default();
    TrialErrors { trial: trial.name.clone(), before: rmse(before), after: rmse(after) }
}

fn manoeuvre(request: &Request<'_>, after: &Model, trial: &Trial) -> Option<SailedManoeuvre> {
    // Trials that are no standard manoeuvre are not compared.
    let recognised = Recognised::of(trial)?;
    let simulated = |model: &Model| -> Option<ManoeuvreMetrics> {
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &ReplaySettings::default())
            .ok()
            .filter(|run| run.stopped.is_none())?;
        recognised.metrics(&run.track, &run.samples)
    };
    let samples: Vec<usize> = (0..trial.len()).collect();
    let measured = recognised.metrics(&recorded_track(trial)?, &samples)?;
    Some(SailedManoeuvre {
        trial: trial.name.clone(),
        measured,
        before: simulated(request.model),
        after: simulated(after),
    })
}
