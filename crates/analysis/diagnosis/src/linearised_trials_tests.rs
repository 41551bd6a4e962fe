#![allow(clippy::unwrap_used)]
use sistership_model::Zoo;

use super::super::nuisance::TermForms;
use super::*;

/// A straight run of the Mariner of so many samples, with noise in every channel but the rudder.
fn trial(samples: usize) -> Trial {
    let noise = |k: usize, phase: f64| 1e-3 * (12.9898 * k as f64 + phase).sin();
    let column = |mean: f64, phase: f64| (0..samples).map(|k| mean + noise(k, phase)).collect();
    let channels = [
        (Channel::U, column(7.7, 0.0)),
        (Channel::V, column(0.0, 1.0)),
        (Channel::R, column(0.0, 2.0)),
        (Channel::Psi, column(0.0, 3.0)),
        (Channel::Delta, vec![0.0; samples]),
    ];
    Trial {
        name: "straight".into(),
        t_s: (0..samples).map(|k| k as f64).collect(),
        channels: channels.into(),
        ..Trial::default()
    }
}

fn mariner() -> CalibratedModel {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, law) = (zoo.find_model("mariner").unwrap(), zoo.law("abkowitz").unwrap());
    CalibratedModel::new(&model, law, &TermForms::new(), &[], &[]).unwrap()
}

#[test]
fn a_channel_of_which_no_noise_can_be_told_is_refused_with_its_trial() {
    let model = mariner();
    let made = |samples: usize| {
        let trial = trial(samples);
        let trials = [&trial];
        LinearisedTrials::new(&model, FilterColumns::default(), &trials, Some(0.5))
            .map(|all| all.noise.keys().copied().collect::<Vec<Channel>>())
    };
    assert_eq!(made(40).unwrap(), [Channel::Psi, Channel::U, Channel::V, Channel::R]);
    let refusal = made(6).unwrap_err().to_string();
    assert!(refusal.starts_with("trial `straight`: the noise of the channel"), "{refusal}");
    assert!(refusal.contains("seven readings"), "{refusal}");
}

/// Stated instruments must have each channel that is read; those learned on other trials are
/// completed by the scatter of these.
#[test]
fn instruments_that_are_stated_have_every_channel_that_is_read() {
    let model = mariner();
    let trial = trial(40);
    let trials = [&trial];
    let all = LinearisedTrials::new(&model, FilterColumns::default(), &trials, Some(0.5)).unwrap();
    let mut less = all.noise.clone();
    less.remove(&Channel::R);
    let planned =
        LinearisedTrials::planned_trials(&model, FilterColumns::default(), &trials, &less);
    let refusal = planned.map(|_| ()).unwrap_err().to_string();
    assert!(refusal.contains("the noise of the channel `r`"), "{refusal}");
    let own = all.noise[&Channel::R];
    less.insert(Channel::U, NoiseLevel::from_deviation(7.0));
    let under = all.with_noise(&less);
    assert_eq!(under.noise[&Channel::R], own);
    assert_eq!(under.noise[&Channel::U].deviation, 7.0);
}
