//! The score of Wakita et al. 2022, Eq. 26, by kind of trial.

use sistership_model::{Law, Model, Trial, Zoo};
use sistership_priors::transfer::{transfer_model, trial_approach};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

/// Restart and scatter of the score of Wakita et al. 2022, Eq. 26.
pub const RESTART_S: f64 = 100.0;
pub const KINDS: [&str; 4] = ["random", "turning", "zigzag", "berthing"];

/// Trials simulated by a model that must sail them all.
pub fn simulated(model: &Model, law: &Law, trials: &[&Trial]) -> Vec<(String, SquaredError)> {
    let mut ship = Ship::new(model, law).expect("a ready ship");
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let one = |trial: &&Trial| {
        let run = replay_trial(&ship, trial, &restarted).expect("every channel that the law needs");
        assert_eq!(run.stopped, None, "{}", trial.name);
        (trial.name.clone(), SquaredError::from_trial(trial, &run))
    };
    trials.iter().map(one).collect()
}

/// Every trial simulated by a source ship's model, scaled to this one and not refined; those that
/// leave the physical range have no error.
pub fn by_source(trials: &[Trial], name: &str) -> Vec<(String, SquaredError)> {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let source = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&source.law).expect("the law of a zoo model");
    let scaled =
        transfer_model(&source, law, target, trial_approach(&trials.iter().collect::<Vec<_>>()));
    let mut ship = Ship::new(&scaled, law).expect("a ready ship");
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let run = |trial: &Trial| {
        replay_trial(&ship, trial, &restarted).expect("every channel that the law needs")
    };
    let sailed =
        trials.iter().map(|trial| (trial, run(trial))).filter(|(_, run)| run.stopped.is_none());
    sailed.map(|(trial, run)| (trial.name.clone(), SquaredError::from_trial(trial, &run))).collect()
}

pub fn of_kind<'e>(
    errors: &'e [(String, SquaredError)],
    kind: &'e str,
) -> impl Iterator<Item = &'e (String, SquaredError)> {
    errors.iter().filter(move |(name, _)| kind == "all" || name.contains(file_prefix(kind)))
}

pub fn over_all(trials: &[Trial], errors: &[(String, SquaredError)], kind: &str) -> f64 {
    let mut sum = SquaredError::default();
    of_kind(errors, kind).for_each(|(_, error)| sum.add(error));
    standardised_mse(&sum, &standard_deviations(&trials.iter().collect::<Vec<_>>())) / 6.0
}

pub fn over_each(trials: &[Trial], errors: &[(String, SquaredError)], kind: &str) -> f64 {
    let one = |(name, error): &(String, SquaredError)| {
        let own: Vec<&Trial> = trials.iter().filter(|trial| trial.name == *name).collect();
        standardised_mse(error, &standard_deviations(&own)) / 6.0
    };
    of_kind(errors, kind).map(one).sum::<f64>() / of_kind(errors, kind).count() as f64
}

/// What the names of a kind's files begin with.
fn file_prefix(kind: &str) -> &str {
    if kind == "turning" { "turn_" } else { kind }
}
