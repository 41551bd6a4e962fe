//! A ship that sails by a law, something that its model lacks, and what the diagnosis makes of it.

#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, Normal};
use sistership_diagnosis::{
    Diagnosis, DiagnosisInputs, OriginKind, Settings, Verdict, calibrate_model, diagnose,
};
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Channel;
use sistership_model::{Effect, Model, Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, at};

const NOISE: [f64; 6] = [2.5e-3, 3e-3, 5e-5, 3.5e-4, 0.3, 0.3];

/// The Mariner with an effect hidden in it, as its own instruments record two manoeuvres.
fn trials(zoo: &Zoo, hidden: Option<AppliedEffect>) -> Vec<Trial> {
    recorded(zoo, hidden, NOISE)
}

fn recorded(zoo: &Zoo, hidden: Option<AppliedEffect>, noise: [f64; 6]) -> Vec<Trial> {
    recorded_with_seed(zoo, hidden, noise, 7)
}

fn recorded_with_seed(
    zoo: &Zoo,
    hidden: Option<AppliedEffect>,
    noise: [f64; 6],
    seed: u64,
) -> Vec<Trial> {
    let mut truth = zoo.find_model("mariner").unwrap();
    truth.effects.extend(hidden);
    let ship = Ship::new(&truth, zoo.law(&truth.law).unwrap()).unwrap();
    let settings = ManoeuvreSettings {
        duration_s: Some(300.0),
        run_in_s: 30.0,
        ..ManoeuvreSettings::default()
    };
    let tracks = [
        simulate_turn(&ship, 15.0, &settings).unwrap().track,
        simulate_zigzag(&ship, 10.0, 10.0, &settings).unwrap().track,
    ];
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    let mut record = |(place, track): (usize, &sistership_simulation::Trajectory)| {
        let mut trial = Trial { name: format!("trial-{place}"), ..Trial::default() };
        trial.t_s = track.t_s.iter().copied().step_by(5).collect();
        for (&(channel, index), sigma) in RECORDED_CHANNELS.iter().zip(noise) {
            let normal = Normal::new(0.0, sigma).unwrap();
            let noisy = track
                .state_column(index)
                .into_iter()
                .step_by(5)
                .map(|value| value + normal.sample(&mut random));
            trial.channels.insert(channel, noisy.collect());
        }
        trial
            .channels
            .insert(Channel::Delta, track.state_column(at::DELTA).into_iter().step_by(5).collect());
        trial
    };
    tracks.iter().enumerate().map(&mut record).collect()
}

fn hidden(zoo: &Zoo, effect: &str, parameters: &[(&str, f64)]) -> AppliedEffect {
    let effect = zoo.effect(effect).unwrap();
    let parameters = parameters
        .iter()
        .map(|(name, value)| ((*name).to_owned(), Quantity::new(*value, "hidden")));
    let form = effect.forms[0].file.clone();
    AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: parameters.collect(),
        form,
    }
}

fn diagnosed(zoo: &Zoo, model: &Model, trials: &[Trial]) -> Diagnosis {
    by(zoo, model, trials, &Settings::default())
}

fn by(zoo: &Zoo, model: &Model, trials: &[Trial], settings: &Settings) -> Diagnosis {
    among(
        &["current", "rudder-offset", "yaw-rate-bias", "extra-resistance"],
        zoo,
        model,
        trials,
        settings,
    )
}

/// By a library of some effects.
fn among(
    names: &[&str],
    zoo: &Zoo,
    model: &Model,
    trials: &[Trial],
    settings: &Settings,
) -> Diagnosis {
    let effects: Vec<Arc<Effect>> =
        names.iter().map(|name| Arc::clone(zoo.effect(name).unwrap())).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let law = zoo.law(&model.law).unwrap();
    diagnose(
        &DiagnosisInputs { model, law, effects: &effects, trials: &trials, settings },
        &|_, _| true,
    )
    .unwrap()
}

fn names(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.effects.iter().map(|found| found.name.as_str()).collect()
}

#[test]
fn nothing_is_missing_from_the_true_model() {
    let zoo = Zoo::load_embedded().unwrap();
    let diagnosis = diagnosed(&zoo, &zoo.find_model("mariner").unwrap(), &trials(&zoo, None));
    assert_eq!(
        diagnosis.verdict,
        Verdict::Complete,
        "{:?} {:?}",
        diagnosis.effects,
        diagnosis.unexplained
    );
    assert!(diagnosis.effects.is_empty() && diagnosis.model.is_none());
}

#[test]
fn a_hidden_current_is_named_with_its_speed_and_direction() {
    let zoo = Zoo::load_embedded().unwrap();
    let effect = hidden(&zoo, "current", &[("north_m_s", 0.3), ("east_m_s", -0.4)]);
    let diagnosis =
        diagnosed(&zoo, &zoo.find_model("mariner").unwrap(), &trials(&zoo, Some(effect)));
    let names: Vec<&str> = diagnosis.effects.iter().map(|found| found.name.as_str()).collect();
    assert_eq!(names, ["current"]);
    let speed = diagnosis.effects[0].parameters["speed_m_s"];
    assert!((speed.value - 0.5).abs() < 0.01, "{speed:?}");
    assert!(
        diagnosis.after["u"] < 0.5 * diagnosis.before["u"],
        "{:?} {:?}",
        diagnosis.before,
        diagnosis.after
    );
}

#[test]
fn a_hidden_rudder_offset_is_named_with_its_angle() {
    let zoo = Zoo::load_embedded().unwrap();
    let effect = hidden(&zoo, "rudder-offset", &[("offset_rad", 0.02)]);
    let diagnosis =
        diagnosed(&zoo, &zoo.find_model("mariner").unwrap(), &trials(&zoo, Some(effect)));
    assert_eq!(diagnosis.effects[0].name, "rudder-offset");
    let offset = diagnosis.effects[0].parameters["offset_rad"];
    assert!((offset.value - 0.02).abs() < 1e-3, "{offset:?}");
}

#[test]
fn an_effect_is_named_above_its_detection_limit_and_not_far_below() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let limits = diagnosed(&zoo, &model, &trials(&zoo, None)).limits;
    let sizes = [("rudder-offset", "offset_rad"), ("extra-resistance", "coefficient")];
    for (effect, parameter) in sizes {
        let limit = limits.iter().find(|limit| limit.effect == effect).unwrap().size.unwrap();
        let of = |share: f64| {
            let hidden = hidden(&zoo, effect, &[(parameter, share * limit)]);
            diagnosed(&zoo, &model, &trials(&zoo, Some(hidden)))
        };
        assert_eq!(names(&of(1.5)), [effect], "{limit}");
        assert!(names(&of(0.5)).is_empty(), "{limit}");
    }
}

#[test]
fn what_is_held_for_impossible_is_not_named() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let trials = trials(&zoo, Some(hidden(&zoo, "rudder-offset", &[("offset_rad", 0.02)])));
    assert_eq!(names(&diagnosed(&zoo, &model, &trials)), ["rudder-offset"]);
    let prior_odds = [("rudder-offset".to_owned(), 1e-300)].into();
    let settings = Settings { prior_odds, ..Settings::default() };
    let diagnosis = by(&zoo, &model, &trials, &settings);
    assert!(!names(&diagnosis).contains(&"rudder-offset"), "{:?}", names(&diagnosis));
    assert!(diagnosis.prior_odds["rudder-offset"] < 1e-299);
}

#[test]
fn a_force_that_no_effect_has_is_told_by_its_equation() {
    let zoo = Zoo::load_embedded().unwrap();
    let effect = hidden(&zoo, "extra-resistance", &[("coefficient", 0.01)]);
    let (trials, model) = (trials(&zoo, Some(effect)), zoo.find_model("mariner").unwrap());
    let diagnosis = among(&["yaw-rate-bias"], &zoo, &model, &trials, &Settings::default());
    assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{:?}", diagnosis.before);
    let first = &diagnosis.origins[0];
    assert_eq!((first.of, first.channel.as_str()), (OriginKind::Acceleration, "u"), "{first:?}");
}

/// A force by the heading, too weak for any segment to exceed the noise, is told by its dependence
/// on the heading; trials of the same instruments without it have none.
#[test]
fn a_weak_force_is_told_by_its_dependence_on_the_heading() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    let (law, effects) = (zoo.law(&model.law).unwrap(), [zoo.effect("yaw-rate-bias").unwrap()]);
    let clean: Vec<Trial> =
        (20..23).flat_map(|seed| recorded_with_seed(&zoo, None, NOISE, seed)).collect();
    let own: Vec<&Trial> = clean.iter().collect();
    let known = calibrate_model(&model, law, &effects.map(Arc::clone), &own, None).unwrap();
    model.uncertainty = Some(known);
    let asked = |hidden| {
        let trials = recorded_with_seed(&zoo, hidden, NOISE, 30);
        among(&["yaw-rate-bias"], &zoo, &model, &trials, &Settings::default())
    };
    let drift = [("north", 1e-5), ("east", 0.0), ("surge_share", 0.4), ("yaw_lever", 0.0)];
    let weak = asked(Some(hidden(&zoo, "wave-drift", &drift)));
    assert_eq!(weak.verdict, Verdict::Unexplained, "{:?}", weak.patterns);
    assert!(weak.patterns.iter().any(|found| found.variable == "psi"), "{:?}", weak.patterns);
    let without = asked(None);
    assert_eq!((without.verdict, without.patterns.as_slice()), (Verdict::Complete, &[][..]));
}

#[test]
fn a_compass_that_swings_is_told_by_its_readings() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut trials = trials(&zoo, None);
    for trial in &mut trials {
        let t_s = trial.t_s.clone();
        let headings = trial.channels.get_mut(&Channel::Psi).unwrap();
        headings.iter_mut().zip(&t_s).for_each(|(psi, t)| *psi += 0.02 * (t / 7.0).sin());
    }
    let diagnosis = diagnosed(&zoo, &zoo.find_model("mariner").unwrap(), &trials);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    let first = &diagnosis.origins[0];
    assert_eq!((first.of, first.channel.as_str()), (OriginKind::Readings, "psi"), "{first:?}");
}

/// A rate gyro of which the noise is larger than what the ship changes in a sample: a delay that is
/// read off a path with this noise in it is there on trials of the very model.
#[test]
fn a_noisy_gyro_is_not_late() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let trials = recorded(&zoo, None, [2.5e-3, 3e-3, 8e-4, 3.5e-4, 0.3, 0.3]);
    let trials: Vec<&Trial> = trials.iter().collect();
    let effects = [Arc::clone(zoo.effect("time-delay").unwrap())];
    let law = zoo.law(&model.law).unwrap();
    let uncertainty = calibrate_model(&model, law, &effects, &trials, None).unwrap();
    let explained = uncertainty.false_alarm_levels["time-delay/yaw-rate"].together;
    assert!(explained < 4.0, "a chi-square of one degree by its mean: {explained}");
}

/// A log through the water beside velocities over the ground: what the hull sees ahead.
fn with_log(trials: &mut [Trial], (north, east): (f64, f64), scale: f64) {
    let mut random = ChaCha12Rng::seed_from_u64(11);
    let noise = Normal::new(0.0, 0.01).unwrap();
    for trial in trials {
        let samples = trial.channels[&Channel::U].iter().zip(&trial.channels[&Channel::Psi]);
        let log = samples.map(|(u, psi)| {
            let along = north * psi.cos() + east * psi.sin();
            (u - along) * scale + noise.sample(&mut random)
        });
        let log = log.collect();
        trial.channels.insert(Channel::UWater, log);
    }
}

#[test]
fn a_log_through_the_water_measures_what_a_current_leaves_of_the_speed() {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, library) = (zoo.find_model("mariner").unwrap(), ["current", "speed-log"]);
    let effect = hidden(&zoo, "current", &[("north_m_s", 0.3), ("east_m_s", -0.4)]);
    let mut trials = trials(&zoo, Some(effect));
    let settings = Settings::default();
    let alone = among(&library, &zoo, &model, &trials, &settings);
    with_log(&mut trials, (0.3, -0.4), 1.0);
    let both = among(&library, &zoo, &model, &trials, &settings);
    assert_eq!((names(&alone), names(&both)), (vec!["current"], vec!["current"]));
    assert_eq!(both.verdict, Verdict::Effects);
    let [without, with] = [&alone, &both].map(|found| found.effects[0].parameters["speed_m_s"]);
    assert!((with.value - 0.5).abs() < 0.01, "{with:?}");
    let [without, with] = [without, with].map(|speed| speed.se);
    assert!(with < without, "{with} with the log, {without} without");
}

#[test]
fn a_log_that_reads_too_much_is_no_current() {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, library) = (zoo.find_model("mariner").unwrap(), ["current", "speed-log"]);
    let mut trials = trials(&zoo, None);
    with_log(&mut trials, (0.0, 0.0), 1.04);
    let found = among(&library, &zoo, &model, &trials, &Settings::default());
    assert_eq!(names(&found), ["speed-log"]);
    let scale = found.effects[0].parameters["scale_percent"];
    assert!((scale.value - 4.0).abs() < 1.0, "{scale:?}");
}
