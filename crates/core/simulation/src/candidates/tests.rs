#![allow(clippy::unwrap_used)]
use super::*;
use crate::plant::{MAX_INPUTS, Plant, PlantWorkspace};
use crate::state::straight_state;
use sistership_model::Zoo;
use sistership_model::quantity::Quantity;

const STEP_S: f64 = 0.5;

/// Inputs of a law while rudder and revolutions change; others at their defaults.
fn inputs(names: &[String], law: &Law, revolutions: f64, t_s: f64) -> Vec<f64> {
    let value = |name: &String| match name.as_str() {
        "delta" => 0.3 * (0.05 * t_s).sin(),
        "n" => revolutions * (0.03 * t_s).cos(),
        _ => law.inputs[name.as_str()].default.unwrap_or(0.0),
    };
    names.iter().map(value).collect()
}

fn plain(
    model: &Model,
    law: &Law,
    start: &StateVector,
    method: Method,
    revolutions: f64,
) -> StateVector {
    let plant = Plant::new(model, law).unwrap();
    let mut work = PlantWorkspace::default();
    (0..200).fold(*start, |state, k| {
        method.advance_state(&state, STEP_S, |fraction, s| {
            let now = inputs(plant.input_names(), law, revolutions, STEP_S * (k as f64 + fraction));
            let mut given = [0.0; MAX_INPUTS];
            given[..now.len()].copy_from_slice(&now);
            plant.state_rate(s, &given, &mut work)
        })
    })
}

fn check(model: &Model, law: &Law, starts: [StateVector; 2], method: Method, revolutions: f64) {
    let system = CandidateSystem::new(model, law).unwrap();
    let coefficients: Vec<f64> =
        system.names().iter().map(|name| model.coefficient(name)).collect();
    let mut run = CandidateRun::<2>::new(&system);
    starts.iter().enumerate().for_each(|(lane, start)| run.start_lane(lane, start));
    for k in 0..200 {
        let at = |fraction: f64| -> Vec<LaneValues<2>> {
            let now =
                inputs(system.input_names(), law, revolutions, STEP_S * (k as f64 + fraction));
            system.prepare_inputs(&now).into_iter().map(|value| [value; 2]).collect()
        };
        run.advance_step(method, STEP_S, [&at(0.0), &at(0.5), &at(1.0)], &coefficients);
    }
    for (lane, start) in starts.iter().enumerate() {
        let end = plain(model, law, start, method, revolutions);
        for (row, &place) in system.state_places().iter().enumerate() {
            let here = run.state_lanes(row)[lane];
            assert!(
                (here - end[place]).abs() < 1e-9 * (1.0 + end[place].abs()),
                "{} {place}: {here} {}",
                model.name,
                end[place]
            );
        }
    }
}

fn starts(speed: f64) -> [StateVector; 2] {
    let (first, mut other) = (straight_state(speed), straight_state(0.8 * speed));
    (other[1], other[2], other[5]) = (0.02 * speed, 0.002, 0.4);
    [first, other]
}

#[test]
fn candidates_sail_as_plain_models() {
    let zoo = Zoo::load_embedded().unwrap();
    for name in ["mariner", "sr108", "esso-tanker", "kvlcc2-7m"] {
        let model = zoo.find_model(name).unwrap();
        let law = zoo.law(&model.law).unwrap();
        let (speed, n) = (model.speed_m_s.unwrap(), model.revolutions_rps.unwrap_or(1.0));
        [Method::Rk4, Method::Euler]
            .into_iter()
            .for_each(|method| check(&model, law, starts(speed), method, n));
    }
}

#[test]
fn submodels_switch_by_lane() {
    let zoo = Zoo::load_embedded().unwrap();
    let law = zoo.law("hybrid-single-screw").unwrap();
    let mut model = zoo.find_model("kvlcc2-7m").unwrap();
    model.law = law.name.clone();
    for (name, value) in [("m_x", 0.05), ("m_y", 0.9), ("I_zz_plus_J_zz", 0.11)] {
        model.parameters.insert(name.into(), Quantity::new(value, "test"));
    }
    for name in law.parameters.keys() {
        if let Some(value) = law.derived_parameter(name, &model.particulars) {
            model.parameters.insert(name.clone(), Quantity::new(value, "test"));
        }
    }
    model.coefficients.clear();
    for (k, name) in law.coefficient_names().into_iter().enumerate() {
        model.coefficients.insert(name, Quantity::new(-0.002 * (1.0 + (k % 7) as f64), "test"));
    }
    let mut starts = starts(0.3);
    starts[1][0] = -0.2;
    check(&model, law, starts, Method::Rk4, 0.5);
}
