//! Stopping, pull-out and spiral against figures that follow without the integration.
#![allow(clippy::unwrap_used)]

use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    AsternOrder, FurtherSelection, ManoeuvreSettings, ReversingError, check_reversing,
    simulate_further_manoeuvres, simulate_pull_out, simulate_spirals, simulate_stop,
};
use sistership_simulation::metrics::is_straight_line_stable;

fn model(name: &str) -> (Model, Law) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model(name).unwrap();
    let law = (**zoo.law(&model.law).unwrap()).clone();
    (model, law)
}

/// MSC/Circ.1053, appendix 3: S = A ln(1 + B), of a resistance that is quadratic in the speed and a
/// thrust astern that does not depend on it. Both are so in Pipchenko's law on a straight course:
/// R = 0.5 rho A_L L d |X_along| u^2, T = rho D^4 K_P n^2.
#[test]
fn a_stop_has_the_track_reach_of_the_explanatory_notes() {
    for name in ["hanjin-pretoria", "captain-plaushevskiy", "csl-spirit"] {
        let (model, law) = model(name);
        let ship = Ship::new(&model, &law).unwrap();
        let p = |name: &str| model.particulars[name].value;
        let q = |name: &str| model.parameters[name].value;
        let rho = model.particulars.get("water_density_kg_m3").map_or(1025.0, |rho| rho.value);
        let (u, n) = (ship.approach_speed_m_s(), ship.revolutions_at(ship.approach_speed_m_s()));
        let area = q("A_L") * p("lpp_m") * p("draught_m");
        let resistance = 0.5 * rho * area * model.coefficients["X_along"].value.abs() * u * u;
        let thrust = rho * p("propeller_diameter_m").powi(4) * q("K_P") * n * n;
        let mass = q("m") * (1.0 + q("k_11"));
        let (a, b) = (mass * u * u / (2.0 * resistance), resistance / thrust);
        let expected_m = a * (1.0 + b).ln();
        let sailed = simulate_stop(
            &model,
            &law,
            &ship,
            &ManoeuvreSettings::default(),
            AsternOrder::default(),
        )
        .unwrap();
        let reach_m = sailed.metrics.track_reach_m.unwrap();
        println!(
            "{name}: {reach_m:.1} m, by the notes {expected_m:.1} m, {:.2} L",
            reach_m / p("lpp_m")
        );
        assert!((reach_m / expected_m - 1.0).abs() < 1e-4, "{name}: {reach_m}, not {expected_m}");
        assert!(sailed.metrics.head_reach_m.unwrap() <= reach_m + 1e-9);
    }
}

/// While the revolutions change, the ship goes on: by about half the time at the speed ahead.
#[test]
fn a_slow_reversal_takes_way() {
    let (model, law) = model("csl-spirit");
    let ship = Ship::new(&model, &law).unwrap();
    let reach = |reversal_s: f64| {
        let order = AsternOrder { reversal_s, ..AsternOrder::default() };
        let sailed =
            simulate_stop(&model, &law, &ship, &ManoeuvreSettings::default(), order).unwrap();
        sailed.metrics.track_reach_m.unwrap()
    };
    let more = (reach(60.0) - reach(0.0)) / ship.approach_speed_m_s();
    assert!((20.0..60.0).contains(&more), "{more} s at the speed ahead");
}

#[test]
fn a_law_that_is_not_told_of_reversing_says_so() {
    let refused = |name: &str| {
        let (model, law) = model(name);
        check_reversing(&model, &law, &Ship::new(&model, &law).unwrap()).unwrap_err()
    };
    assert!(matches!(refused("mariner"), ReversingError::NoRevolutions { .. }));
    for name in ["kvlcc2", "esso-tanker", "sr108", "cybership-2", "tanker-173m"] {
        assert!(matches!(refused(name), ReversingError::FirstQuadrant { .. }), "{name}");
    }
}

/// The SR 108 and the Mariner are stable on a straight course, the Esso tanker is not (van Berlekom
/// and Goddard 1972); both of the latter turn with the rudder amidships, which spirals see through.
#[test]
fn pull_outs_and_spirals_tell_stable_ships_from_unstable_ones() {
    for (name, by_pull_outs, stable) in
        [("sr108", Some(true), true), ("mariner", None, true), ("esso-tanker", None, false)]
    {
        let (model, law) = model(name);
        let ship = Ship::new(&model, &law).unwrap();
        let settings = ManoeuvreSettings::default();
        let sail = |rudder| simulate_pull_out(&ship, rudder, &settings).unwrap().metrics;
        let both = [sail(20.0), sail(-20.0)];
        assert_eq!(is_straight_line_stable(&both), by_pull_outs, "{name}: {both:?}");
        let all = simulate_further_manoeuvres(
            &model,
            &law,
            &ship,
            &settings,
            &FurtherSelection::default_selection(),
        );
        assert_eq!(all.straight_line_stable, Some(stable), "{name}");
        assert_eq!(all.spiral.is_some(), by_pull_outs != Some(true), "{name}");
    }
}

/// What both spirals say of one ship agrees, and what the reverse one says is a steady turn.
#[test]
fn the_spirals_agree_on_the_loop() {
    for name in ["mariner", "esso-tanker", "kvlcc2"] {
        let (model, law) = model(name);
        let ship = Ship::new(&model, &law).unwrap();
        let clock = std::time::Instant::now();
        let sailed = simulate_spirals(&ship, &ManoeuvreSettings::default()).unwrap();
        println!(
            "{name}: direct {:.2} deg, reverse {:.2} deg, height {:.3} deg/s, limit {:.1} deg, \
             {:?}",
            sailed.direct_loop_width_deg,
            sailed.loop_width_deg,
            sailed.loop_height_deg_s,
            sailed.width_limit_deg,
            clock.elapsed()
        );
        assert!((sailed.direct_loop_width_deg - sailed.loop_width_deg).abs() < 1.0 + 1.0);
    }
}
