//! Every model of the zoo with a surge balance: it stops and goes astern, and within the range of
//! its trials it stays what it was.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::validity::Region;
use sistership_model::{Law, Model, Zoo};
use sistership_propulsion::{PropulsionEvidence, PropulsionFault, check_straight, model_balance};
use sistership_simulation::Ship;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{StateVector, at, straight_state};

/// A trial at constant revolutions, in which the speed falls to six tenths.
fn trial(model: &Model) -> Trial {
    let (speed, n_rps) = (model.speed_m_s.unwrap(), model.revolutions_rps.unwrap());
    let share = |k: usize| 1.0 - 0.4 * k as f64 / 99.0;
    let channels = BTreeMap::from([
        (Channel::U, (0..100).map(|k| share(k) * speed).collect()),
        (Channel::N, vec![n_rps; 100]),
    ]);
    Trial { t_s: (0..100).map(f64::from).collect(), channels, ..Trial::default() }
}

/// Models of the zoo at constant revolutions; those of their approach are 1/s where the law takes
/// none.
fn models(zoo: &Zoo) -> Vec<(Model, Law)> {
    let of = |vessel: &std::sync::Arc<sistership_model::Vessel>| {
        let mut model = zoo.find_model(vessel.name()).ok()?;
        let law = zoo.law(&model.law)?.as_ref().clone();
        model.speed_m_s?;
        model.revolutions_rps = model.revolutions_rps.or(Some(1.0));
        Some((model, law))
    };
    zoo.vessels().filter_map(of).collect()
}

fn balanced(model: &Model, law: &Law) -> Model {
    balanced_by(model, law, &trial(model))
}

fn balanced_by(model: &Model, law: &Law, trial: &Trial) -> Model {
    let evidence =
        PropulsionEvidence { model, law, source: None, estimate: None, trials: &[trial] };
    Model { propulsion: model_balance(&evidence), ..model.clone() }
}

fn rate(ship: &Ship, state: &StateVector, delta_rad: f64, n_rps: f64) -> StateVector {
    ship.rate_at(state, delta_rad, n_rps, &mut PlantWorkspace::default())
}

#[test]
fn every_model_stops_and_goes_astern() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut failed = Vec::new();
    let all = models(&zoo);
    for (model, law) in &all {
        let before = Ship::new(model, law).map(|ship| check_straight(&ship));
        let Ok(ship) = Ship::new(&balanced(model, law), law) else { continue };
        let after = check_straight(&ship);
        println!("{:24} {:22} before {before:?}, after {after:?}", model.name, law.name);
        if let Err(fault) = after {
            failed.push(format!("{}: {fault}", model.name));
        }
    }
    assert!(all.len() > 20 && failed.is_empty(), "{failed:#?}");
}

#[test]
fn a_model_without_a_length_has_no_balance() {
    let zoo = Zoo::load_embedded().unwrap();
    let (mut model, law) = models(&zoo).remove(0);
    assert!(balanced(&model, &law).propulsion.is_some());
    model.particulars.remove("lpp_m");
    assert_eq!(balanced(&model, &law).propulsion, None);
}

#[test]
fn within_its_trials_a_model_stays_what_it_was() {
    let zoo = Zoo::load_embedded().unwrap();
    for (model, law) in models(&zoo) {
        let Ok(before) = Ship::new(&model, &law) else { continue };
        let after = Ship::new(&balanced(&model, &law), &law).unwrap();
        let (speed, n_rps) = (model.speed_m_s.unwrap(), model.revolutions_rps.unwrap());
        for k in 0..20_u32 {
            let share = f64::from(k) / 19.0;
            let mut state = straight_state((0.6 + 0.4 * share) * speed);
            state[at::V] = 0.2 * speed * (share - 0.5);
            state[at::R] = 0.5 * (0.7 - share) * speed / before.lpp_m();
            let [old, new] = [&before, &after].map(|ship| rate(ship, &state, 0.2 * share, n_rps));
            let size = old.amax().max(1e-9);
            assert!((old - new).amax() < 1e-9 * size, "{} at {state}: {old} {new}", model.name);
        }
    }
}

#[test]
fn at_half_of_its_revolutions_a_ship_turns_half_as_fast() {
    let zoo = Zoo::load_embedded().unwrap();
    let without_roll = models(&zoo).into_iter().filter(|(_, law)| !law.has_roll());
    let mut tried = 0;
    for (model, law) in without_roll {
        let Ok(ship) = Ship::new(&balanced(&model, &law), &law) else { continue };
        let (speed, n_rps) = (model.speed_m_s.unwrap(), model.revolutions_rps.unwrap());
        let at_share = |share: f64| {
            let mut state = straight_state(0.8 * share * speed);
            state[at::V] = 0.1 * share * speed;
            state[at::R] = -0.3 * share * speed / ship.lpp_m();
            rate(&ship, &state, 0.2, share * n_rps)
        };
        for axis in [at::U, at::V, at::R] {
            let (whole, half) = (at_share(1.0)[axis], at_share(0.5)[axis]);
            assert!((half - 0.25 * whole).abs() < 1e-6 * whole.abs(), "{}: {axis}", model.name);
        }
        tried += 1;
    }
    assert!(tried >= 15, "{tried}");
}

/// A trial in which the speed falls to six tenths, and the revolutions by a share of that.
fn losing_trial(model: &Model, loss: f64) -> Trial {
    let mut trial = trial(model);
    let n_rps = model.revolutions_rps.unwrap();
    let share = |k: usize| 1.0 - 0.4 * loss * k as f64 / 99.0;
    trial.channels.insert(Channel::N, (0..100).map(|k| share(k) * n_rps).collect());
    trial
}

#[test]
fn revolutions_that_were_lost_in_turns_alone_are_not_covered_straight_ahead() {
    const LOSS: f64 = 0.5;
    let zoo = Zoo::load_embedded().unwrap();
    let without_roll = models(&zoo).into_iter().filter(|(_, law)| !law.has_roll());
    let mut tried = 0;
    for (mut model, law) in without_roll {
        model.revolutions_loss = Some(LOSS);
        let Ok(own) = Ship::new(&model, &law) else { continue };
        let trial = losing_trial(&model, LOSS);
        let model = balanced_by(&model, &law, &trial);
        let ship = Ship::new(&model, &law).unwrap();
        // Models that are steady at another speed than that of the approach are scaled to it.
        let speed = model.propulsion.as_ref().unwrap().value("speed").unwrap();
        let n_rps = model.revolutions_rps.unwrap();
        let straight = |ship: &Ship, share: f64| {
            rate(ship, &straight_state(share * speed), 0.1, share * n_rps)
        };
        // 85 % of the revolutions are within 80 to 100 % of the trials, at other speeds.
        let (whole, less) = (straight(&ship, 1.0), straight(&ship, 0.85));
        let size = whole.amax();
        for axis in [at::U, at::V, at::R] {
            let alike = 0.85_f64.powi(2) * whole[axis];
            assert!((less[axis] - alike).abs() < 1e-6 * size, "{}: {axis}", model.name);
        }
        // In a turn at full speed the engine has them, and the law alone counts.
        let approach = model.speed_m_s.unwrap();
        let mut turning = straight_state(0.7 * approach);
        turning[at::R] = 0.2 * approach / own.lpp_m();
        let [old, new] = [&own, &ship].map(|ship| rate(ship, &turning, 0.3, 0.85 * n_rps));
        assert!((old - new).amax() < 1e-6 * old.amax(), "{}: {old} {new}", model.name);
        tried += 1;
    }
    assert!(tried >= 15, "{tried}");
}

#[test]
fn trials_whose_revolutions_are_all_zero_scale_nothing() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = Model { revolutions_rps: Some(1.5), ..zoo.find_model("mariner").unwrap() };
    let law = zoo.law(&model.law).unwrap();
    let mut trial = trial(&model);
    trial.channels.insert(Channel::N, vec![0.0; 100]);
    let ship = Ship::new(&balanced_by(&model, law, &trial), law).unwrap();
    let mut state = straight_state(0.8 * ship.approach_speed_m_s());
    state[at::V] = 0.3;
    let ahead = rate(&ship, &state, 0.2, 1.5);
    assert!(ahead.iter().all(|value| value.is_finite()), "{ahead}");
}

#[test]
fn a_law_without_revolutions_runs_on_for_ever() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let law = zoo.law(&model.law).unwrap();
    let fault = check_straight(&Ship::new(&model, law).unwrap()).unwrap_err();
    assert_eq!(fault, PropulsionFault::NoRevolutions);
    let model = Model { revolutions_rps: Some(1.5), ..model };
    let ship = Ship::new(&balanced(&model, law), law).unwrap();
    assert!(ship.has_propeller());
    let speed = ship.approach_speed_m_s();
    let surge = |share: f64, turns: f64| {
        rate(&ship, &straight_state(share * speed), 0.0, turns * 1.5)[at::U] / speed * ship.lpp_m()
    };
    assert!(surge(1.0, 0.0) < 0.0 && surge(1.0, -1.0) < surge(1.0, 0.0));
    assert!(surge(0.0, 0.0).abs() < 1e-6 && surge(-0.5, 0.0) > 0.0);
    assert!(surge(0.0, -1.0) < 0.0 && surge(0.0, 1.0) > -surge(0.0, -1.0));
}

/// A ship that creeps at a share of its approach with the propeller stopped.
fn creeping(zoo: &Zoo, creep: f64) -> (Model, Law) {
    let law = zoo.law("low-speed").unwrap().as_ref().clone();
    let mut model = Model { law: law.name.clone(), ..zoo.find_model("mariner").unwrap() };
    let [speed, n_rps] = [model.speed_m_s.unwrap(), 1.5];
    let lpp_m = model.particulars["lpp_m"].value;
    let unit = (9.81 * lpp_m).sqrt();
    let quantities = |values: &[(&str, f64)]| {
        let of = |(name, value): &(&str, f64)| ((*name).to_owned(), Quantity::new(*value, "made"));
        values.iter().map(of).collect::<BTreeMap<_, _>>()
    };
    let inertia =
        [("m", 8e-3), ("X_udot", -4e-4), ("Y_vdot", -7e-3), ("I_z", 5e-4), ("N_rdot", -4e-4)];
    model.parameters =
        law.parameters.keys().map(|name| (name.clone(), Quantity::new(0.0, "made"))).collect();
    model.parameters.extend(quantities(&inertia));
    let drag = 0.05 * 8.4e-3;
    let [creep, full] = [creep, 1.0].map(|share| drag * (share * speed / unit).powi(2));
    let thrust = (full - creep) * unit / (n_rps * lpp_m);
    model.coefficients = quantities(&[("X_0", creep), ("X_uu", -drag), ("X_n", thrust)]);
    model.revolutions_rps = Some(n_rps);
    (model, law)
}

#[test]
fn what_counts_as_rest_goes_by_the_greatest_speed_of_the_trials() {
    let (mut model, law) = creeping(&Zoo::load_embedded().unwrap(), 0.2);
    let check = |model: &Model| check_straight(&Ship::new(model, &law).unwrap());
    let late = |fault| matches!(fault, Err(PropulsionFault::Late { share, .. }) if share < 0.21);
    assert!(late(check(&model)), "{:?}", check(&model));
    let covered = |most| Region::from_samples(&BTreeMap::from([("u".to_owned(), vec![0.0, most])]));
    let speed = model.speed_m_s.unwrap();
    model.validity = covered(1.9 * speed);
    assert!(late(check(&model)), "{:?}", check(&model));
    model.validity = covered(2.3 * speed);
    assert_eq!(check(&model), Ok(()));
}

#[test]
fn a_ship_that_loses_less_than_half_of_its_speed_is_never_at_rest() {
    let (mut model, law) = creeping(&Zoo::load_embedded().unwrap(), 0.6);
    let speed = model.speed_m_s.unwrap();
    let columns = BTreeMap::from([("u".to_owned(), vec![0.0, 20.0 * speed])]);
    model.validity = Region::from_samples(&columns);
    let fault = check_straight(&Ship::new(&model, &law).unwrap()).unwrap_err();
    assert!(matches!(fault, PropulsionFault::Late { .. }), "{fault}");
}

#[test]
fn parameters_that_lack_or_are_unknown_are_named() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = Model { revolutions_rps: Some(1.5), ..zoo.find_model("mariner").unwrap() };
    let law = zoo.law(&model.law).unwrap();
    let whole = balanced(&model, law);
    assert_eq!(whole.check_against(law), Ok(()));
    let mut less = whole.clone();
    less.propulsion.as_mut().unwrap().parameters.remove("loading");
    assert_eq!(less.check_against(law).unwrap_err().0, "propulsion.parameters.loading");
    let mut more = whole;
    let parameters = &mut more.propulsion.as_mut().unwrap().parameters;
    parameters.insert("pitch".to_owned(), parameters["loading"].clone());
    assert_eq!(more.check_against(law).unwrap_err().0, "propulsion.parameters.pitch");
}
