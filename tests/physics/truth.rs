//! The ships of the truth, by which the program is judged: symmetric, stable or unstable as they
//! are named, of bounded energy.

use std::sync::LazyLock;

use proptest::prelude::*;
use sistership_simulation::StateVector;
use sistership_simulation::state::{at, straight_state};
use sistership_tests::truth::causes;
use sistership_tests::truth::container::container;
use sistership_tests::truth::family;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{Manoeuvre, figures};
use sistership_tests::truth::model_tanker::model_tanker;
use sistership_tests::truth::motion::{Truth, step};
use sistership_tests::truth::stability::growth_rate;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::trials;

fn ships() -> Vec<Box<dyn Truth + Send>> {
    vec![
        Box::new(tanker()),
        Box::new(ferry()),
        Box::new(container()),
        Box::new(model_tanker()),
        Box::new(family::single_screw(1)),
        Box::new(family::twin_screw(1)),
    ]
}

/// The same, made once: some find their steady approach by simulation.
static SHIPS: LazyLock<Vec<Box<dyn Truth + Send>>> = LazyLock::new(ships);

/// Kinetic energy of the rigid body by its mass, m2/s2.
fn energy(ship: &dyn Truth, state: &StateVector) -> f64 {
    let size = ship.dimensions();
    let across = state[at::V] + size.x_g_m * state[at::R];
    let turning = size.yaw_gyradius_ratio * size.lpp_m * state[at::R];
    0.5 * (state[at::U].powi(2) + across.powi(2) + turning.powi(2))
}

#[test]
fn the_tanker_does_not_keep_a_straight_line_and_the_ferry_and_the_container_ship_do() {
    let rates = [growth_rate(&tanker()), growth_rate(&ferry()), growth_rate(&container())];
    println!(
        "growth of a small yaw rate by U/L: {rates:?}, model {}",
        growth_rate(&model_tanker())
    );
    assert!(rates[0] > 0.01 && rates[1] < -0.01 && rates[2] < -0.01, "{rates:?}");
}

#[test]
fn every_ship_turns_and_ends_its_zigzags() {
    for ship in ships() {
        let (size, figures) = (ship.dimensions(), figures(&*ship));
        println!("{} {:.2} rps: {figures:.1?}", size.name, ship.revolutions_rps());
        assert_eq!(figures.len(), 12, "{}: {figures:?}", size.name);
        let diameter = figures["turn 35 deg: tactical diameter"] / size.lpp_m;
        assert!((1.5..8.0).contains(&diameter), "{}: {diameter} lengths", size.name);
    }
}

#[test]
fn the_approach_is_steady() {
    for ship in ships() {
        let speed = ship.dimensions().speed_m_s;
        let [surge, sway, yaw, roll] =
            ship.accelerations(&straight_state(speed), ship.revolutions_rps());
        let unit = speed * speed / ship.dimensions().lpp_m;
        assert!(surge.abs() < 1e-6 * unit, "{}: {surge} m/s2", ship.dimensions().name);
        assert!(sway.abs() + yaw.abs() + roll.abs() < 1e-12, "{}", ship.dimensions().name);
    }
}

/// Nothing hidden is nothing: a rudder that is held for a step would follow half of it late, which
/// a diagnosis names.
#[test]
fn trials_with_nothing_hidden_are_those_of_the_ship() {
    let ship = family::twin_screw(1);
    let perfect = Instruments::PERFECT;
    let manoeuvre = Manoeuvre::Zigzag(10.0, 10.0);
    let plain = trials(&ship, &[manoeuvre], &perfect, 1).remove(0);
    let course = causes::Course { manoeuvre, heading_deg: 0.0 };
    let hidden = causes::Hidden::default();
    let among = causes::trials(&ship, &hidden, &[course], &perfect, 1).remove(0);
    assert_eq!(plain.t_s, among.t_s);
    for (channel, values) in &plain.channels {
        let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        for (here, there) in values.iter().zip(&among.channels[channel]) {
            assert!((here - there).abs() <= 1e-9 * largest, "{channel:?}: {here} and {there}");
        }
    }
}

/// The propeller gives no more than it gave on the approach, so no manoeuvre has more energy than
/// that; without it, ever less.
#[test]
fn energy_stays_bounded() {
    for ship in ships() {
        let size = ship.dimensions();
        let first = energy(&*ship, &straight_state(size.speed_m_s));
        for manoeuvre in [Manoeuvre::Turn(35.0), Manoeuvre::Random(35.0, 9)] {
            let track = manoeuvre.sailed(&*ship);
            let most = track.states.iter().map(|state| energy(&*ship, state)).fold(0.0, f64::max);
            assert!(most < 1.02 * first, "{} {}: {most}", size.name, manoeuvre.name());
        }
        let mut state = straight_state(size.speed_m_s);
        state[at::V] = 0.2 * size.speed_m_s;
        let start = energy(&*ship, &state);
        for _ in 0..(40.0 * size.length_time_s() / 0.1) as usize {
            state = step(&*ship, &state, 0.0, 0.0);
        }
        assert!(energy(&*ship, &state) < 0.5 * start, "{}: coasting", size.name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn mirrored_motion_has_mirrored_accelerations(
        u in 0.2..1.1_f64, v in -0.4..0.4_f64, r in -0.8..0.8_f64, phi in -0.3..0.3_f64, delta in -0.6..0.6_f64,
    ) {
        for ship in SHIPS.iter() {
            let size = ship.dimensions();
            let mut state = StateVector::zeros();
            state[at::U] = u * size.speed_m_s;
            state[at::V] = v * size.speed_m_s;
            state[at::R] = r / size.length_time_s();
            state[at::DELTA] = delta;
            if size.upright.is_some() {
                state[at::PHI] = phi;
                state[at::P] = 0.3 * phi / size.length_time_s();
            }
            let mut mirrored = state;
            for odd in [at::V, at::R, at::PHI, at::P, at::DELTA] {
                mirrored[odd] = -mirrored[odd];
            }
            let n_rps = ship.revolutions_rps();
            let here = ship.accelerations(&state, n_rps);
            let there = ship.accelerations(&mirrored, n_rps);
            for (axis, sign) in [1.0, -1.0, -1.0, -1.0].into_iter().enumerate() {
                let scale = here[axis].abs().max(1e-9);
                prop_assert!(
                    (here[axis] - sign * there[axis]).abs() < 1e-9 * scale.max(1e-3),
                    "{} {axis}: {} {}", size.name, here[axis], there[axis]
                );
            }
        }
    }
}
