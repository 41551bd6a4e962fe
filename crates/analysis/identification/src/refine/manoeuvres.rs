//! Standard manoeuvres of a model, and the manoeuvres among the trials.

use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres,
};
use sistership_simulation::metrics::{ManoeuvreRecognition, recorded_track};
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, TrialReplay, replay_trials};

use super::outcome::MeasuredManoeuvre;
use super::problem::RefinementProblem;
use sistership_priors::transfer::prepare_ship;

/// Returns the turning circles and zigzags among the trials, as measured and as simulated by both
/// models with the recorded rudder.
pub(super) fn measured_manoeuvres(
    problem: &RefinementProblem<'_>,
    refined: &Model,
) -> Vec<MeasuredManoeuvre> {
    // Whole trials, not the parts in which they may be held out: a manoeuvre is recognised from its
    // beginning.
    let trials = problem
        .whole
        .iter()
        .map(|trial| (*trial, true))
        .chain(problem.judged.iter().map(|trial| (*trial, false)));
    let recognised: Vec<(&Trial, bool, ManoeuvreRecognition)> = trials
        .filter_map(|(trial, fitted)| {
            Some((trial, fitted, ManoeuvreRecognition::from_trial(trial)?))
        })
        .collect();
    let trials: Vec<&Trial> = recognised.iter().map(|(trial, ..)| *trial).collect();
    let [source, refined] = [&problem.transferred, refined]
        .map(|model| replay_whole_trials(model, problem.law, &trials));
    let one = |(k, (trial, fitted, recognised)): (usize, &(&Trial, bool, ManoeuvreRecognition))| {
        let samples: Vec<usize> = (0..trial.len()).collect();
        let simulated = |runs: &[TrialReplay]| {
            let run = runs.get(k).filter(|run| run.stopped.is_none())?;
            recognised.track_metrics(&run.track, &run.samples)
        };
        Some(MeasuredManoeuvre {
            trial: trial.name.clone(),
            fitted: *fitted,
            measured: recognised.track_metrics(&recorded_track(trial)?, &samples)?,
            source: simulated(&source),
            refined: simulated(&refined),
        })
    };
    recognised.iter().enumerate().filter_map(one).collect()
}

/// Simulations of trials from beginning to end by a model; empty if it cannot be set up.
fn replay_whole_trials(model: &Model, law: &Law, trials: &[&Trial]) -> Vec<TrialReplay> {
    let Ok(ship) = prepare_ship(model, law, trials) else { return Vec::new() };
    let recorded: Vec<RecordedTrial<'_>> =
        trials.iter().map(|trial| RecordedTrial { trial, coefficients: &[] }).collect();
    replay_trials(&ship, &recorded, &ReplaySettings::default()).unwrap_or_default()
}

/// Returns the standard manoeuvres of a model; its only failure is the error if it cannot be set
/// up.
pub(super) fn standard_manoeuvres(model: &Model, law: &Law) -> StandardManoeuvres {
    match Ship::new(model, law) {
        Ok(ship) => simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default()),
        Err(error) => {
            StandardManoeuvres { failures: vec![error.to_string()], ..Default::default() }
        }
    }
}
