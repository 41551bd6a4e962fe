//! Trials as instruments would have shown them that do not err.

#![allow(clippy::unwrap_used)]

use sistership_model::effect::AppliedEffect;
use sistership_model::manifest::VelocityFrame;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo};
use sistership_simulation::plant::{MAX_INPUTS, PlantWorkspace};
use sistership_simulation::recorded::{ReplaySettings, correct_instrument_errors, replay_trial};
use sistership_simulation::ship::Ship;
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector};

/// An effect, its form, and its parameters.
type Erring<'a> = (&'a str, &'a str, &'a [(&'a str, f64)]);

fn mariner(zoo: &Zoo, effects: &[Erring<'_>]) -> Ship {
    let one = |&(effect, form, values): &Erring<'_>| {
        let effect = zoo.effect(effect).unwrap();
        let form = effect.forms.iter().find(|own| own.file.name == form).unwrap();
        let parameters = values
            .iter()
            .map(|&(name, value)| (name.to_owned(), Quantity::new(value, "test")))
            .collect();
        AppliedEffect {
            name: effect.name.clone(),
            acts_on: effect.acts_on,
            parameters,
            form: form.file.clone(),
        }
    };
    let model =
        Model { effects: effects.iter().map(one).collect(), ..zoo.find_model("mariner").unwrap() };
    Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap()
}

/// Rudder to and fro, and the motion that follows.
fn sailed(ship: &Ship) -> Trial {
    let t_s: Vec<f64> = (0..300).map(f64::from).collect();
    let mut trial =
        Trial { name: "to and fro".into(), velocity: VelocityFrame::Ground, ..Trial::default() };
    for (channel, _) in RECORDED_CHANNELS {
        trial
            .channels
            .insert(channel, vec![if channel == Channel::U { 7.5 } else { 0.0 }; t_s.len()]);
    }
    trial.channels.insert(Channel::Delta, t_s.iter().map(|t| 0.2 * (t / 20.0).sin()).collect());
    trial.t_s = t_s;
    let run = replay_trial(ship, &trial, &ReplaySettings::default()).unwrap();
    for (channel, place) in RECORDED_CHANNELS {
        trial.channels.insert(channel, run.track.states.iter().map(|state| state[place]).collect());
    }
    trial
}

/// What a ship's instruments show of a trial.
fn shown(ship: &Ship, trial: &Trial) -> Trial {
    let recorded = |name: &str, sample: usize| {
        trial.channel(Channel::by_name(name)?).map(|column| column[sample])
    };
    let (mut shown, mut work) = (trial.clone(), PlantWorkspace::default());
    for sample in 0..trial.len() {
        let mut state = StateVector::zeros();
        for (channel, place) in RECORDED_CHANNELS
            .into_iter()
            .chain([(Channel::Delta, sistership_simulation::state::at::DELTA)])
        {
            state[place] = trial.channels[&channel][sample];
        }
        let mut inputs = [0.0; MAX_INPUTS];
        let given =
            ship.law_inputs().map(|(name, default)| recorded(name, sample).or(default).unwrap());
        given.zip(&mut inputs).for_each(|(value, input)| *input = value);
        let said = ship.instrument_readings(trial.velocity, &state, &inputs, &mut work);
        RECORDED_CHANNELS.iter().for_each(|(channel, place)| {
            shown.channels.get_mut(channel).unwrap()[sample] = said[*place]
        });
    }
    shown
}

fn farthest(a: &Trial, b: &Trial, channel: Channel) -> f64 {
    a.channels[&channel]
        .iter()
        .zip(&b.channels[&channel])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn errors_of_instruments_are_undone() {
    let zoo = Zoo::load_embedded().unwrap();
    let truth = sailed(&mariner(&zoo, &[]));
    let erring = mariner(
        &zoo,
        &[
            ("lever-arm", "gnss", &[("forward_m", 40.0), ("starboard_m", 5.0)]),
            ("time-delay", "heading", &[("delay_s", 2.0)]),
            ("yaw-rate-bias", "constant", &[("bias_rad_s", 0.002)]),
        ],
    );
    let shown = shown(&erring, &truth);
    assert!(
        farthest(&shown, &truth, Channel::V) > 0.1 && farthest(&shown, &truth, Channel::Psi) > 0.01,
        "nothing errs"
    );
    let undone = correct_instrument_errors(&erring, &shown).unwrap();
    for (channel, limit) in [
        (Channel::U, 1e-6),
        (Channel::V, 1e-6),
        (Channel::R, 1e-8),
        (Channel::Psi, 1e-7),
        (Channel::X, 1e-4),
    ] {
        let left = farthest(&undone, &truth, channel);
        assert!(left < limit, "{channel}: {left}");
    }
}

#[test]
fn instruments_that_do_not_err_leave_a_trial_as_it_is() {
    let ship = mariner(&Zoo::load_embedded().unwrap(), &[]);
    let trial = sailed(&ship);
    assert_eq!(correct_instrument_errors(&ship, &trial).unwrap(), trial);
}
