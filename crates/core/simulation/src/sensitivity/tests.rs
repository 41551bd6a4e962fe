#![allow(clippy::unwrap_used)]
use super::*;
use crate::integrate::Method;
use crate::plant::{MAX_INPUTS, Plant, PlantWorkspace};
use crate::state::{StateVector, straight_state};
use crate::tape::LaneValues;
use sistership_model::{Law, Model, Zoo};

const STEP_S: f64 = 0.5;
const STEPS: usize = 120;

fn ready(name: &str) -> (Model, Law) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model(name).unwrap();
    let law = zoo.law(&model.law).unwrap();
    (model, (**law).clone())
}

/// The inputs of a law while the rudder swings; other inputs at their defaults, revolutions those
/// of the approach.
fn inputs(names: &[String], law: &Law, model: &Model, t_s: f64) -> Vec<f64> {
    let value = |name: &String| match name.as_str() {
        "delta" => 0.2 * (0.05 * t_s).sin(),
        "n" => model.revolutions_rps.unwrap_or(1.0),
        _ => law.inputs[name.as_str()].default.unwrap_or(0.0),
    };
    names.iter().map(value).collect()
}

fn plain(model: &Model, law: &Law, start: &StateVector, method: Method) -> StateVector {
    let plant = Plant::new(model, law).unwrap();
    let mut work = PlantWorkspace::default();
    let mut state = *start;
    for k in 0..STEPS {
        state = method.advance_state(&state, STEP_S, |fraction, s| {
            let mut given = [0.0; MAX_INPUTS];
            let now = inputs(plant.input_names(), law, model, STEP_S * (k as f64 + fraction));
            given[..now.len()].copy_from_slice(&now);
            plant.state_rate(s, &given, &mut work)
        });
    }
    state
}

fn sensitive<'a>(
    system: &'a SensitiveSystem,
    model: &Model,
    law: &Law,
    starts: &[StateVector; 2],
    method: Method,
) -> SensitiveRun<'a, 2> {
    let mut run = SensitiveRun::<2>::new(system);
    starts.iter().enumerate().for_each(|(lane, start)| run.start(lane, start));
    for k in 0..STEPS {
        let at = |fraction: f64| -> Vec<LaneValues<2>> {
            let t_s = STEP_S * (k as f64 + fraction);
            inputs(system.input_names(), law, model, t_s)
                .into_iter()
                .map(|value| [value; 2])
                .collect()
        };
        run.advance_step(method, STEP_S, [&at(0.0), &at(0.5), &at(1.0)]);
    }
    run
}

fn starts(speed: f64) -> [StateVector; 2] {
    // Not quite straight: a law may have a kink there.
    let (mut first, mut other) = (straight_state(speed), straight_state(0.8 * speed));
    first[1] = -0.01 * speed;
    (other[1], other[2], other[5]) = (0.02 * speed, 0.002, 0.4);
    [first, other]
}

/// A central difference of fourth order.
fn difference(at: impl Fn(f64) -> StateVector, by: f64) -> StateVector {
    ((at(by) - at(-by)) * 8.0 - (at(2.0 * by) - at(-2.0 * by))) / (12.0 * by)
}

fn close(exact: f64, difference: f64, scale: f64, within: f64) -> bool {
    (exact - difference).abs() <= within * (difference.abs() + scale)
}

fn check(name: &str, method: Method, within: f64) {
    let (model, law) = ready(name);
    let system = SensitiveSystem::new(&model, &law).unwrap();
    let starts = starts(model.speed_m_s.unwrap());
    let run = sensitive(&system, &model, &law, &starts, method);
    for (lane, start) in starts.iter().enumerate() {
        let end = plain(&model, &law, start, method);
        for &place in system.state_places() {
            assert!(
                (run.state(lane)[place] - end[place]).abs() < 1e-9 * (1.0 + end[place].abs()),
                "{name} state {place}"
            );
        }
        for (column, coefficient) in system.names().iter().enumerate().step_by(3) {
            let at = |by: f64| {
                let mut moved = model.clone();
                moved.coefficients.get_mut(coefficient).unwrap().value += by;
                plain(&moved, &law, start, method)
            };
            let by = 1e-4 * model.coefficient(coefficient).abs().max(1e-2);
            let slope = difference(at, by);
            for (row, &place) in system.state_places().iter().enumerate() {
                let exact = run.state_sensitivities(lane, row)[column];
                assert!(
                    close(exact, slope[place], 1e-3 * slope.norm(), within),
                    "{name} {coefficient} {place}: {exact} {}",
                    slope[place]
                );
            }
        }
        for (column, &from) in system.state_places().iter().enumerate() {
            let at = |by: f64| {
                let mut moved = *start;
                moved[from] += by;
                plain(&model, &law, &moved, method)
            };
            let slope = difference(at, 1e-5);
            for (row, &place) in system.state_places().iter().enumerate() {
                let exact = run.state_sensitivities(lane, row)[system.names().len() + column];
                assert!(
                    close(exact, slope[place], 1e-3 * slope.norm(), within),
                    "{name} start {from} {place}: {exact} {}",
                    slope[place]
                );
            }
        }
    }
}

#[test]
fn sensitivities_to_parameters_are_those_of_differences() {
    let (model, law) = ready("kvlcc2-7m");
    let names = ["w_P0", "t_P", "a_H", "l_R", "kappa"].map(str::to_owned);
    let system = SensitiveSystem::with_parameters(&model, &law, &names).unwrap();
    let starts = starts(model.speed_m_s.unwrap());
    let run = sensitive(&system, &model, &law, &starts, Method::Rk4);
    let mut gathered = vec![0.0; system.names().len()];
    for (own, name) in names.iter().enumerate() {
        let at = |by: f64| {
            let mut moved = model.clone();
            moved.parameters.get_mut(name).unwrap().value += by;
            plain(&moved, &law, &starts[1], Method::Rk4)
        };
        let slope = difference(at, 1e-4);
        for (row, &place) in system.state_places().iter().enumerate() {
            system.gather_sensitivities(run.state_sensitivities(1, row), &mut gathered);
            let exact = gathered[model.coefficients.len() + own];
            assert!(
                close(exact, slope[place], 1e-3 * slope.norm(), 5e-4),
                "{name} {place}: {exact} {}",
                slope[place]
            );
        }
    }
}

#[test]
fn parameters_of_the_masses_have_no_sensitivities() {
    let (model, law) = ready("kvlcc2-7m");
    let error = SensitiveSystem::with_parameters(&model, &law, &["m_y".to_owned()]);
    assert!(error.is_err());
}

#[test]
fn sensitivities_are_those_of_differences() {
    check("mariner", Method::Rk4, 2e-5);
    check("sr108", Method::Rk4, 2e-5);
    check("esso-tanker", Method::Rk4, 2e-5);
    // Differences reach over the kinks of its rudder inflow.
    check("kvlcc2-7m", Method::Rk4, 5e-4);
}

#[test]
fn of_the_explicit_euler_method_too() {
    check("mariner", Method::Euler, 2e-5);
    check("sr108", Method::Euler, 2e-5);
}
