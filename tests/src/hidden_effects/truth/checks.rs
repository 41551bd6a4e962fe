//! The true ship checked against the library's manoeuvres and against independent examples.

use crate::shared;
use sistership_simulation::Trajectory;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::at;
use sistership_simulation::{Ship, StateVector};

use super::instruments::{NOISE, said};
use super::sailing::{DURATION_S, N_RPS};
use super::{Hidden, Manoeuvre, Sailing, TrueShip, ZOO, effect, published, trials};

fn sailing(manoeuvre: Manoeuvre, heading_deg: f64, execute_s: f64) -> Sailing {
    Sailing { manoeuvre, heading_deg, execute_s }
}

fn largest_difference(a: &Trajectory, b: &Trajectory) -> f64 {
    assert_eq!(a.states.len(), b.states.len());
    a.states.iter().zip(&b.states).map(|(a, b)| (a - b).abs().max()).fold(0.0, f64::max)
}

#[test]
fn a_clean_ship_sails_as_the_library_does() {
    let model = published();
    let ship = Ship::new(&model, ZOO.law(&model.law).unwrap()).unwrap();
    let settings = ManoeuvreSettings {
        speed_m_s: Some(N_RPS / ship.revolutions_at(1.0)),
        duration_s: Some(DURATION_S - 60.0),
        run_in_s: 60.0,
        ..ManoeuvreSettings::default()
    };
    let truth = TrueShip::new(&Hidden::default());
    let own = |manoeuvre| truth.sail(&sailing(manoeuvre, 0.0, 60.0), &[]);
    let turned = simulate_turn(&ship, 12.0, &settings).unwrap().track;
    let zigzagged = simulate_zigzag(&ship, -10.0, 5.0, &settings).unwrap().track;
    assert!(largest_difference(&own(Manoeuvre::Turn(12.0)), &turned) < 1e-6);
    assert!(largest_difference(&own(Manoeuvre::Zigzag(-10.0, 5.0)), &zigzagged) < 1e-6);
}

/// The largest root mean square of the difference from an example, by its noise.
fn against_example(hidden: &Hidden, file: &str, sailing: &Sailing) -> Option<f64> {
    let columns = shared::columns(&shared::data("sr108/examples")?.join(file));
    let ship = TrueShip::new(hidden);
    let said = said(&ship, &ship.sail(sailing, &[]), &[]);
    let of = |&(channel, place, deviation): &(sistership_model::trial::Channel, usize, f64)| {
        let name = channel
            .column_name()
            .replace("_m_s", "_mps")
            .replace("r_rad_s", "r_radps")
            .replace("p_rad_s", "p_radps");
        let measured = columns.get(&name).unwrap_or_else(|| panic!("no column {name}"));
        let square = |(state, measured): (&StateVector, &f64)| (state[place] - measured).powi(2);
        let mean = said.iter().zip(measured).map(square).sum::<f64>() / said.len() as f64;
        println!("{file} {channel:>6}: {:.3} of the noise", mean.sqrt() / deviation);
        mean.sqrt() / deviation
    };
    Some(NOISE.iter().map(of).fold(0.0, f64::max))
}

#[test]
fn the_examples_are_sailed_within_their_noise() {
    let knots = 0.6 * std::f64::consts::FRAC_1_SQRT_2;
    let hidden = |effects| Hidden { effects, ..Hidden::default() };
    let hides = [
        ("i_control", hidden(Vec::new())),
        (
            "b_current06",
            hidden(vec![effect(
                "current",
                "constant",
                &[("north_m_s", knots), ("east_m_s", knots)],
            )]),
        ),
        (
            "c_rudder_offset1p5",
            hidden(vec![effect(
                "rudder-offset",
                "constant",
                &[("offset_rad", 1.5_f64.to_radians())],
            )]),
        ),
    ];
    // The turns only: when exactly a zigzag reverses is the bridge's business.
    for (kind, hidden) in &hides {
        for heading_deg in [0.0, 90.0] {
            let file = format!("{kind}__turn_p12__h{heading_deg:03}__noisy.csv");
            let turn = sailing(Manoeuvre::Turn(12.5), heading_deg, 30.0);
            let Some(worst) = against_example(hidden, &file, &turn) else { return };
            assert!(worst < 1.15, "{file}: {worst} of the noise");
        }
    }
}

#[test]
fn the_rudder_lags_and_the_compass_is_late() {
    let zigzag = sailing(Manoeuvre::Zigzag(10.0, 10.0), 0.0, 60.0);
    let sailed = |hidden: &Hidden| {
        let ship = TrueShip::new(hidden);
        let track = ship.sail(&zigzag, &[]);
        (said(&ship, &track, &[]), track)
    };
    let clean = sailed(&Hidden::default());
    let with = |name, form, values: &[(&str, f64)]| {
        sailed(&Hidden { effects: vec![effect(name, form, values)], ..Hidden::default() })
    };
    let late = with("time-delay", "heading", &[("delay_s", 1.5)]);
    assert_eq!(late.1, clean.1);
    assert!((late.0[203][at::PSI] - clean.0[200][at::PSI]).abs() < 1e-9);
    assert!((late.0[203][at::U] - clean.0[203][at::U]).abs() < 1e-9);
    // A ramp and a constant order: the yaw comes one time constant later.
    let lagging = with("rudder-lag", "first-order", &[("time_constant_s", 3.0)]);
    let reached = |track: &Trajectory| {
        track.states.iter().position(|state| state[at::PSI] > 0.1).unwrap() as f64 * 0.1
    };
    let behind = reached(&lagging.1) - reached(&clean.1);
    assert!((behind - 3.0).abs() < 0.3, "{behind} s");
}

#[test]
fn the_same_seed_gives_the_same_trials() {
    let programme = [sailing(Manoeuvre::Turn(12.0), 90.0, 60.0)];
    let trial = |seed| trials(&Hidden::default(), &programme, seed);
    assert_eq!(trial(3), trial(3));
    assert_ne!(trial(3), trial(4));
}
