//! Trials as simulated by models that did not see them.

use rayon::prelude::*;
use sistership_model::Model;
use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{Recorded, Replay, ReplaySettings, replay_all};

use super::outcome::RefineError;
use super::problem::Problem;
use sistership_priors::transfer::ready_for_sisters;

/// Trials that are simulated in lockstep.
const TOGETHER: usize = 8;

/// The errors of simulated trials.
pub(super) struct Simulated {
    pub total: SquaredError,
    pub each: Vec<SquaredError>,
    /// The first divergence.
    pub reason: Option<String>,
}

impl Simulated {
    /// Of an option that is out of the question.
    pub fn refused(reason: String) -> Self {
        Self { total: SquaredError::default(), each: Vec::new(), reason: Some(reason) }
    }

    fn of(trials: &[&Trial], runs: &[Replay]) -> Self {
        let mut total = SquaredError::default();
        let each: Vec<SquaredError> =
            trials.iter().zip(runs).map(|(trial, run)| SquaredError::of(trial, run)).collect();
        each.iter().for_each(|error| total.add(error));
        let stopped = |(trial, run): (&&Trial, &Replay)| {
            Some(format!("{} {}", trial.name, run.stopped.as_ref()?))
        };
        Self { total, each, reason: trials.iter().zip(runs).find_map(stopped) }
    }
}

/// Simulates what is fitted and left out, each with its model, at no finer steps than it takes.
///
/// # Errors
/// A trial lacks a channel, or the models differ in more than their coefficients.
pub(super) fn simulate_training(
    problem: &Problem<'_>,
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<Simulated, RefineError> {
    let trials = problem.replayed.trials.iter().collect::<Vec<_>>();
    simulate(problem, (&trials, problem.replayed.step_s), models, model_of)
}

/// Simulates trials, each with its model; the first divergence is the reason against the candidate.
///
/// # Errors
/// As [`simulate_training`].
pub(super) fn simulate_all(
    problem: &Problem<'_>,
    trials: &[&Trial],
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<Simulated, RefineError> {
    simulate(problem, (trials, ReplaySettings::default().step_s), models, model_of)
}

/// Simulates trials by steps of at most so many seconds.
fn simulate(
    problem: &Problem<'_>,
    (trials, step_s): (&[&Trial], f64),
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<Simulated, RefineError> {
    let Some(first) = models.first().filter(|_| !trials.is_empty()) else {
        return Ok(Simulated::of(&[], &[]));
    };
    let ship = match ready_for_sisters(first, problem.law, trials) {
        Ok(ship) => ship,
        Err(error) => return Ok(Simulated::refused(error.to_string())),
    };
    let coefficients = sisters(&ship, models)?;
    let numbered = trials.iter().enumerate();
    let all: Vec<_> = numbered
        .map(|(k, trial)| Recorded { trial, coefficients: &coefficients[model_of(k)] })
        .collect();
    let restart_s = problem.settings.restart_s;
    let settings = ReplaySettings { restart_s, step_s, ..ReplaySettings::default() };
    let together = |some: &[Recorded<'_>]| {
        replay_all(&ship, some, &settings)
            .map_err(|e| RefineError::Channel { trial: e.trial, channel: e.channel })
    };
    let runs: Vec<Vec<Replay>> =
        all.par_chunks(TOGETHER).map(together).collect::<Result<_, _>>()?;
    Ok(Simulated::of(trials, &runs.concat()))
}

/// The coefficients of models, as a ship with their law takes them.
///
/// # Errors
/// They differ in more than their coefficients.
pub(super) fn sisters(ship: &Ship, models: &[Model]) -> Result<Vec<Vec<f64>>, RefineError> {
    let one = |model: &Model| {
        let differ = || {
            RefineError::Law(format!("`{}` has not the coefficients of its sisters", model.name))
        };
        ship.sister(model).ok_or_else(differ)
    };
    models.iter().map(one).collect()
}
