//! Ships in lockstep sail as each would alone.
#![allow(clippy::unwrap_used)]

use sistership_model::trial::Channel;
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, simulate_standard_ensemble, simulate_standard_manoeuvres, simulate_turn,
    simulate_zigzag,
};
use sistership_simulation::recorded::{
    RecordedTrial, ReplaySettings, TrialReplay, replay_trial, replay_trials,
};
use sistership_simulation::state::at;

fn ready(name: &str) -> (Model, std::sync::Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model(name).unwrap();
    let law = zoo.law(&model.law).unwrap().clone();
    (model, law)
}

/// A turn as it would be recorded, of some length.
fn trial(ship: &Ship, rudder_deg: f64, samples: usize) -> Trial {
    let settings = ManoeuvreSettings { step_s: Some(1.0), ..ManoeuvreSettings::default() };
    let track = simulate_turn(ship, rudder_deg, &settings).unwrap().track;
    let column = |index: usize| track.state_column(index)[..samples].to_vec();
    let channels =
        [(Channel::U, at::U), (Channel::V, at::V), (Channel::R, at::R), (Channel::Psi, at::PSI)];
    let mut trial = Trial { name: format!("turn {rudder_deg}"), ..Trial::default() };
    trial.t_s = track.t_s[..samples].to_vec();
    trial.channels = channels.iter().map(|&(channel, index)| (channel, column(index))).collect();
    trial.channels.insert(Channel::Delta, column(at::DELTA));
    trial.channels.insert(Channel::N, track.n_rps[..samples].to_vec());
    trial
}

fn trials(ship: &Ship) -> Vec<Trial> {
    [(35.0, 300), (-20.0, 41), (10.0, 200), (5.0, 2), (-35.0, 120)]
        .map(|(rudder, samples)| trial(ship, rudder, samples))
        .to_vec()
}

const RESTARTED: fn() -> ReplaySettings =
    || ReplaySettings { restart_s: Some(37.0), ..ReplaySettings::default() };

#[test]
fn trials_in_lockstep_are_simulated_as_each_alone() {
    for name in ["mariner", "kvlcc2", "sr108"] {
        let (model, law) = ready(name);
        let ship = Ship::new(&model, &law).unwrap();
        let trials = trials(&ship);
        let recorded: Vec<RecordedTrial<'_>> =
            trials.iter().map(|trial| RecordedTrial { trial, coefficients: &[] }).collect();
        let together = replay_trials(&ship, &recorded, &RESTARTED()).unwrap();
        let alone: Vec<TrialReplay> =
            trials.iter().map(|trial| replay_trial(&ship, trial, &RESTARTED()).unwrap()).collect();
        assert_eq!(together, alone, "{name}");
        let whole = ReplaySettings::default();
        assert_eq!(
            replay_trials(&ship, &recorded[..1], &whole).unwrap()[0],
            replay_trials(&ship, &recorded, &whole).unwrap()[0]
        );
    }
}

#[test]
fn manoeuvres_in_lockstep_are_sailed_as_each_alone() {
    let (model, law) = ready("mariner");
    let ship = Ship::new(&model, &law).unwrap();
    let settings = ManoeuvreSettings::default();
    let all = simulate_standard_manoeuvres(&ship, &settings);
    assert_eq!(all.turns[1], simulate_turn(&ship, -35.0, &settings).unwrap().metrics);
    assert_eq!(all.zigzags[2], simulate_zigzag(&ship, 20.0, 20.0, &settings).unwrap().metrics);
}

#[test]
fn sisters_sail_by_their_own_coefficients() {
    let (model, law) = ready("mariner");
    let changed = |factor: f64| {
        let mut sister = model.clone();
        sister.coefficients.get_mut("N_delta").unwrap().value *= factor;
        sister
    };
    let models = [1.0, 0.9, 1.1].map(changed);
    let sisters = Ship::with_open_coefficients(&model, &law).unwrap();
    let coefficients: Vec<Vec<f64>> =
        models.iter().map(|model| sisters.open_coefficient_values(model).unwrap()).collect();
    let given: Vec<&[f64]> = coefficients.iter().map(Vec::as_slice).collect();
    let settings = ManoeuvreSettings::default();
    for (model, sailed) in
        models.iter().zip(simulate_standard_ensemble(&sisters, &given, &settings))
    {
        let alone = simulate_standard_manoeuvres(&Ship::new(model, &law).unwrap(), &settings);
        let (here, there) = (
            sailed.turns[0].tactical_diameter_m.unwrap(),
            alone.turns[0].tactical_diameter_m.unwrap(),
        );
        assert!((here / there - 1.0).abs() < 1e-9, "{here} {there}");
    }
    assert_eq!(sisters.open_coefficient_values(&ready("kvlcc2").0), None);
}

#[test]
fn a_sister_that_diverges_disturbs_no_other() {
    let (model, law) = ready("mariner");
    let sisters = Ship::with_open_coefficients(&model, &law).unwrap();
    let own = sisters.open_coefficient_values(&model).unwrap();
    let wild: Vec<f64> = own.iter().map(|value| -50.0 * value).collect();
    let trial = trial(&Ship::new(&model, &law).unwrap(), 20.0, 200);
    let recorded =
        [&own, &wild, &own].map(|coefficients| RecordedTrial { trial: &trial, coefficients });
    let runs = replay_trials(&sisters, &recorded, &ReplaySettings::default()).unwrap();
    assert!(runs[1].stopped.is_some() && runs[1].samples.len() < 200);
    assert_eq!(runs[0], runs[2]);
    assert_eq!(
        runs[0],
        replay_trials(&sisters, &recorded[..1], &ReplaySettings::default()).unwrap()[0]
    );
}
