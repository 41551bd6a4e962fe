//! The craft that are foreign to the zoo: steady on the approach, symmetric where they should be,
//! of decaying energy without propulsion, and physical with the propeller stopped and reversed.

use sistership_simulation::state::at;
use sistership_tests::truth::foreign::Kind;
use sistership_tests::truth::foreign::coasting::Coasting;
use sistership_tests::truth::foreign::craft::Craft;
use sistership_tests::truth::foreign::motion::Motion;
use sistership_tests::truth::foreign::screw::Screw;
use sistership_tests::truth::foreign::simulate::{
    Run, advance, growth_rate, simulate, start, turning,
};
use sistership_tests::truth::manoeuvre::Manoeuvre;

/// Kinds whose propeller pushes the stern to one side.
const ASYMMETRIC: [Kind; 2] = [Kind::Outboard, Kind::Cargo];

fn craft() -> Vec<(Kind, Craft)> {
    Kind::ALL.into_iter().flat_map(|kind| [1, 2].map(|seed| (kind, kind.craft(seed)))).collect()
}

#[test]
fn the_approach_is_steady_and_straight_where_the_craft_is_symmetric() {
    for (kind, craft) in craft() {
        let speed = craft.size().speed_m_s;
        let rate = craft.rate(&start(&craft, 1.0), &craft.orders(1.0, 0.0));
        let unit = speed * speed / craft.size().lpp_m;
        assert!(rate.body[at::U].abs() < 1e-6 * unit, "{kind:?}: {}", rate.body[at::U]);
        let aside = rate.body[at::V].abs() + rate.body[at::R].abs() * craft.size().lpp_m;
        assert_eq!(aside > 1e-9 * unit, ASYMMETRIC.contains(&kind), "{kind:?}: {aside}");
    }
}

#[test]
fn mirrored_motion_has_mirrored_accelerations_where_no_propeller_walks() {
    for (kind, craft) in craft() {
        let differs = mirrored_difference(&craft);
        if ASYMMETRIC.contains(&kind) {
            assert!(differs > 1e-4, "{kind:?} walks: {differs}");
        } else {
            assert!(differs < 1e-9, "{kind:?}: {differs}");
        }
    }
}

/// Largest difference of accelerations to those of the mirrored motion, by their size, over motions
/// ahead and astern.
fn mirrored_difference(craft: &Craft) -> f64 {
    let (speed, length_s) = (craft.size().speed_m_s, craft.size().length_time_s());
    let mut most = 0.0_f64;
    for (u, v, r, angle, n) in [
        (1.0, -0.1, 0.4, 0.3, 1.0),
        (0.6, 0.2, -0.7, -0.5, 1.1),
        (0.5, -0.3, 0.2, 0.1, -0.7),
        (-0.4, 0.1, 0.3, 0.2, -0.8),
    ] {
        let mut motion = Motion::straight(u * speed, [n * craft.rated_rps(); 2]);
        motion.body[at::V] = v * speed;
        motion.body[at::R] = r / length_s;
        motion.body[at::DELTA] = angle;
        motion.n_rps[1] *= if craft.shafts() > 1 { 1.1 } else { 1.0 };
        let orders = craft.orders_at(craft.rated_rps(), angle);
        let here = craft.rate(&motion, &orders).body;
        for odd in [at::V, at::R, at::DELTA] {
            motion.body[odd] = -motion.body[odd];
        }
        if craft.shafts() > 1 {
            motion.n_rps.swap(0, 1);
        }
        let orders = craft.orders_at(craft.rated_rps(), -angle);
        let there = craft.rate(&motion, &orders).body;
        for (place, sign) in [(at::U, 1.0), (at::V, -1.0), (at::R, -1.0)] {
            let gap = (here[place] - sign * there[place]).abs();
            most = most.max(gap / here[place].abs());
        }
    }
    most
}

/// Kinetic energy of the craft and the water that moves with it, J.
fn energy(craft: &Craft, motion: &Motion) -> f64 {
    let ([u, v, r], inertia) = (motion.velocities(), craft.inertia());
    let across = inertia.sway_kg * v * v + inertia.yaw_kg_m2 * r * r;
    0.5 * (inertia.surge_kg * u * u + across + 2.0 * inertia.sway_by_yaw_kg_m * v * r)
}

#[test]
fn energy_decays_once_the_propeller_stands_still() {
    for (kind, craft) in craft() {
        let length_s = craft.size().length_time_s();
        let mut from = start(&craft, 1.0);
        from.body[at::V] = 0.15 * craft.size().speed_m_s;
        from.body[at::R] = 0.2 / length_s;
        from.n_rps = [0.0; 2];
        let idle = craft.orders_at(0.0, 0.0);
        let track = simulate(&craft, from, 40.0 * length_s, |_, _| idle);
        let energies: Vec<f64> = track.motions.iter().map(|m| energy(&craft, m)).collect();
        let every = energies.len() / 40;
        let samples: Vec<f64> = energies.iter().step_by(every).copied().collect();
        let grows = samples.windows(2).any(|pair| pair[1] > 1.001 * pair[0]);
        assert!(!grows, "{kind:?}: {samples:?}");
        assert!(samples[40] < 0.3 * samples[0], "{kind:?}: {samples:?}");
    }
}

#[test]
fn every_craft_coasts_to_rest_and_goes_astern() {
    for (kind, craft) in craft() {
        let runs = Coasting::simulate(&craft);
        let (speed, length_s) = (craft.size().speed_m_s, craft.size().length_time_s());
        let (coasted, reversed) = (runs.stopped.speeds(), runs.reversed.speeds());
        let last = reversed[reversed.len() - 1] / speed;
        let rest = runs.rest_s.map(|rest_s| rest_s / length_s);
        let coasting = runs.stopped.t_s[runs.stopped.t_s.len() - 1] / length_s;
        println!("{kind:?}: coasts {coasting:.0} L/U, at rest {rest:?} L/U, astern {last:.2} U");
        assert!(coasted[coasted.len() - 1] < 0.101 * speed, "{kind:?}: {coasting} L/U");
        assert!(rest.is_some_and(|rest| (1.0..40.0).contains(&rest)), "{kind:?}: {rest:?}");
        assert!((-0.9..-0.05).contains(&last), "{kind:?}: {last}");
    }
}

#[test]
fn every_craft_turns_and_keeps_its_course_more_or_less() {
    for (kind, craft) in craft() {
        let (lpp_m, speed) = (craft.size().lpp_m, craft.size().speed_m_s);
        let diameters = [35.0, -35.0].map(|angle| {
            turning(&craft, angle).tactical_diameter_m.expect("it turns by half a circle") / lpp_m
        });
        let run = Run { manoeuvre: Manoeuvre::Turn(35.0), speed: 1.0 }.simulate(&craft);
        let end = &run.motions[run.motions.len() - 1];
        let kept = end.body[at::U] / speed;
        println!(
            "{kind:?} {:.1} m {speed:.1} m/s {:.2} rps: {diameters:.2?} L, u {kept:.2}, n {:.2}, \
             growth {:.2}, drift {:.0} deg, roll {:.1} deg",
            lpp_m,
            craft.rated_rps(),
            end.n_rps[0] / craft.rated_rps(),
            growth_rate(&craft),
            -(end.body[at::V]).atan2(end.body[at::U]).to_degrees(),
            run.motions.iter().map(|m| m.body[at::PHI].to_degrees().abs()).fold(0.0, f64::max),
        );
        let widest = if craft.steers_by_difference() { 16.0 } else { 8.0 };
        assert!(diameters.iter().all(|d| (1.2..widest).contains(d)), "{kind:?}: {diameters:?}");
        // More revolutions on one side than are taken from the other give more thrust.
        let most = if craft.steers_by_difference() { 1.2 } else { 1.0 };
        assert!((0.15..most).contains(&kept), "{kind:?}: {kept}");
        let held = craft.steers_by_difference() || end.n_rps[0] < 1.13 * craft.rated_rps();
        assert!(held, "{kind:?}: {:?}", end.n_rps);
    }
}

#[test]
fn half_the_step_gives_the_same_motion() {
    for (kind, craft) in craft() {
        let (step, length_s) = (craft.step_s(), craft.size().length_time_s());
        let orders = craft.orders(1.0, 0.6);
        let (mut coarse, mut fine) = (start(&craft, 1.0), start(&craft, 1.0));
        for _ in 0..(5.0 * length_s / step) as usize {
            coarse = advance(&craft, &coarse, &orders, step);
            fine = advance(&craft, &fine, &orders, 0.5 * step);
            fine = advance(&craft, &fine, &orders, 0.5 * step);
        }
        let heading = (coarse.body[at::PSI] - fine.body[at::PSI]).to_degrees().abs();
        let speed = (coarse.body[at::U] - fine.body[at::U]).abs() / craft.size().speed_m_s;
        assert!(heading < 0.05 && speed < 5e-4, "{kind:?}: {heading} deg, {speed}");
    }
}

#[test]
fn the_car_carrier_loses_revolutions_in_a_turn_and_heels_outward() {
    let craft = Kind::CarCarrier.craft(1);
    let run = Run { manoeuvre: Manoeuvre::Turn(35.0), speed: 1.0 }.simulate(&craft);
    let end = &run.motions[run.motions.len() - 1];
    let left = end.n_rps[0] / craft.rated_rps();
    assert!((0.6..0.97).contains(&left), "{left}");
    assert!(
        end.body[at::PHI] < -0.01,
        "heel to port in a turn to starboard: {}",
        end.body[at::PHI]
    );
}

#[test]
fn a_propeller_has_the_characteristics_of_the_wageningen_series() {
    let screw =
        Screw { density_kg_m3: 1000.0, diameter_m: 1.0, pitch_ratio: 1.0, area_ratio: 0.55 };
    let at = |j: f64| screw.turned(j, 1.0);
    let [bollard, ahead] = [at(0.0), at(0.7)];
    assert!((0.40..0.48).contains(&(bollard.thrust_n / 1000.0)), "{bollard:?}");
    assert!((0.055..0.085).contains(&(bollard.torque_n_m / 1000.0)), "{bollard:?}");
    let efficiency = 0.7 * ahead.thrust_n / (std::f64::consts::TAU * ahead.torque_n_m);
    assert!((0.5..0.7).contains(&efficiency), "{efficiency}");
    assert!(at(1.1).thrust_n < 0.0, "{:?}", at(1.1));
    let [locked, astern] = [screw.turned(3.0, 0.0), screw.turned(0.0, -1.0)];
    assert!(locked.thrust_n < 0.0 && astern.thrust_n < -0.6 * bollard.thrust_n, "{astern:?}");
}
