//! Simulations of held-out trials by models that were fitted without them.

use rayon::prelude::*;
use sistership_model::Model;
use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::horizons::HorizonErrors;
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, TrialReplay, replay_trials};

use super::outcome::RefineError;
use super::problem::RefinementProblem;
use sistership_priors::transfer::prepare_sister_ships;

/// Number of trials that are simulated in lockstep.
const LOCKSTEP_TRIALS: usize = 8;

/// The errors of simulated trials.
#[derive(Default)]
pub(super) struct SimulatedErrors {
    /// Squared errors over all trials.
    pub total: SquaredError,
    /// Standardised errors at the restart interval of the simulations; empty if the models cannot
    /// be simulated at all.
    pub horizons: Vec<HorizonErrors>,
    /// First divergence, or the reason of a refusal.
    pub reason: Option<String>,
}

impl SimulatedErrors {
    /// Creates the errors of an option that is refused without simulations.
    pub fn with_refusal(reason: String) -> Self {
        Self { reason: Some(reason), ..Self::default() }
    }

    fn new(problem: &RefinementProblem<'_>, trials: &[&Trial], runs: &[TrialReplay]) -> Self {
        let mut total = SquaredError::default();
        let each: Vec<SquaredError> = trials
            .iter()
            .zip(runs)
            .map(|(trial, run)| SquaredError::from_trial(trial, run))
            .collect();
        each.iter().for_each(|error| total.add(error));
        // A single stopped simulation excludes the candidate; its errors are kept for the report.
        let stopped = |(trial, run): (&&Trial, &TrialReplay)| {
            Some(format!("{} {}", trial.name, run.stopped.as_ref()?))
        };
        let reason = trials.iter().zip(runs).find_map(stopped);
        let horizons = vec![HorizonErrors::new(&total, &each, &problem.deviations)];
        Self { total, horizons, reason }
    }
}

/// Simulates the training trials, each by its model, at the shortest restart interval and at no
/// finer steps than comparison needs; the first divergence is the reason against the candidate.
///
/// # Errors
/// Returns an error if a trial lacks a channel, or the models differ in more than their
/// coefficients.
pub(super) fn simulate_training(
    problem: &RefinementProblem<'_>,
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<SimulatedErrors, RefineError> {
    let trials = problem.replayed.trials.iter().collect::<Vec<_>>();
    let how = (problem.settings.restart_s, problem.replayed.step_s);
    simulate_errors(problem, (&trials, how), models, model_of)
}

/// Simulates the training trials at the longer restart intervals, where a simulation that stops
/// counts as an error.
///
/// # Errors
/// As [`simulate_training`]; also returns an error if the models cannot be simulated.
pub(super) fn simulate_longer(
    problem: &RefinementProblem<'_>,
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<Vec<HorizonErrors>, RefineError> {
    let trials = problem.replayed.trials.iter().collect::<Vec<_>>();
    let one = |&restart_s: &f64| {
        let how = (Some(restart_s), problem.replayed.step_s);
        let runs = match replay_runs(problem, (&trials, how), models, model_of)? {
            Ok(runs) => runs,
            Err(reason) => return Err(RefineError::Diverged(reason)),
        };
        Ok(HorizonErrors::with_stops(&trials, &runs, &problem.deviations))
    };
    problem.settings.longer_restarts_s.iter().map(one).collect()
}

/// Simulates trials, each by its model, at the shortest restart interval; the first divergence is
/// the reason against the candidate.
///
/// # Errors
/// As [`simulate_training`].
pub(super) fn simulate_all(
    problem: &RefinementProblem<'_>,
    trials: &[&Trial],
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<SimulatedErrors, RefineError> {
    let how = (problem.settings.restart_s, ReplaySettings::default().step_s);
    simulate_errors(problem, (trials, how), models, model_of)
}

/// Simulations of trials from their first samples, each by its model; `None` if the models cannot be
/// simulated or one does not run to its end.
pub(super) fn simulate_runs(
    problem: &RefinementProblem<'_>,
    trials: &[&Trial],
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Option<Vec<TrialReplay>> {
    let how = (None, problem.replayed.step_s);
    let runs = replay_runs(problem, (trials, how), models, model_of).ok()?.ok()?;
    runs.iter().all(|run| run.stopped.is_none()).then_some(runs)
}

/// Trials with the restart interval and the longest step, s.
type ReplayPlan<'a> = (&'a [&'a Trial], (Option<f64>, f64));

/// The errors of a simulation, refused if the models cannot be simulated.
fn simulate_errors(
    problem: &RefinementProblem<'_>,
    simulation: ReplayPlan<'_>,
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<SimulatedErrors, RefineError> {
    Ok(match replay_runs(problem, simulation, models, model_of)? {
        Ok(runs) => SimulatedErrors::new(problem, simulation.0, &runs),
        Err(reason) => SimulatedErrors::with_refusal(reason),
    })
}

/// The simulations, or the reason (inner error) why the models cannot be simulated at all.
fn replay_runs(
    problem: &RefinementProblem<'_>,
    (trials, (restart_s, step_s)): ReplayPlan<'_>,
    models: &[Model],
    model_of: &(dyn Fn(usize) -> usize + Sync),
) -> Result<Result<Vec<TrialReplay>, String>, RefineError> {
    let Some(first) = models.first().filter(|_| !trials.is_empty()) else {
        return Ok(Ok(Vec::new()));
    };
    // Models of one candidate differ in their coefficients only, so that one ship with exchanged
    // coefficients simulates all of them in lockstep.
    let ship = match prepare_sister_ships(first, problem.law, trials) {
        Ok(ship) => ship,
        Err(error) => return Ok(Err(error.to_string())),
    };
    let coefficients = sister_coefficients(&ship, models)?;
    let numbered = trials.iter().enumerate();
    let all: Vec<_> = numbered
        .map(|(k, trial)| RecordedTrial { trial, coefficients: &coefficients[model_of(k)] })
        .collect();
    let settings = ReplaySettings { restart_s, step_s, ..ReplaySettings::default() };
    let together = |some: &[RecordedTrial<'_>]| {
        replay_trials(&ship, some, &settings).map_err(RefineError::from)
    };
    let runs: Vec<Vec<TrialReplay>> =
        // Chunks are simulated in parallel and keep their order.
        all.par_chunks(LOCKSTEP_TRIALS).map(together).collect::<Result<_, _>>()?;
    Ok(Ok(runs.concat()))
}

/// Returns the coefficients of models in the order of a ship with their law.
///
/// # Errors
/// Returns an error if the models differ in more than their coefficients.
pub(super) fn sister_coefficients(
    ship: &Ship,
    models: &[Model],
) -> Result<Vec<Vec<f64>>, RefineError> {
    let one = |model: &Model| {
        let differ = || {
            RefineError::Law(format!(
                "`{}` has other coefficients than the models simulated with \
                                      it",
                model.name
            ))
        };
        ship.open_coefficient_values(model).ok_or_else(differ)
    };
    models.iter().map(one).collect()
}
