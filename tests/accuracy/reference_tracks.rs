//! Our ships against another group's implementations of the same laws, and against published
//! turning circles.

use sistership_model::Zoo;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn};
use sistership_simulation::state::{at, straight_state};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship, Trajectory};
use sistership_tests::shared;

/// Largest differences in position (m) and heading (deg) against a reference file until a time.
struct Largest {
    position_m: f64,
    heading_deg: f64,
}

/// Sails the recorded orders with RK4 at 0.1 s and compares at every stored sample.
fn follow(
    ship: &Ship,
    file: &std::path::Path,
    speed: f64,
    until_s: f64,
    order: impl Fn(f64, &[f64; 9]) -> f64,
) -> Largest {
    let reference = shared::columns(file);
    let n_rps = reference
        .get("n_rps")
        .map(|n| n[0])
        .or_else(|| reference.get("n_rpm").map(|n| n[0] / 60.0))
        .unwrap_or(0.0);
    let t = &reference["t_s"];
    let duration_s = t.iter().copied().fold(0.0, f64::max).min(until_s);
    let mut track = Trajectory::default();
    let run =
        RunSettings { start: straight_state(speed), duration_s, step_s: 0.1, method: Method::Rk4 };
    ship.simulate_orders(run, &mut track, |t_s, state| {
        let state: [f64; 9] = (*state).into();
        Some(HelmOrder { delta_rad: order(t_s, &state), n_rps })
    })
    .unwrap_or_else(|stopped| panic!("{}: {stopped}", file.display()));
    let mut largest = Largest { position_m: 0.0, heading_deg: 0.0 };
    for (k, &t_s) in t.iter().enumerate().filter(|(_, t_s)| **t_s <= duration_s + 1e-9) {
        let state = &track.states[(t_s / 0.1).round() as usize];
        let away = (state[at::X] - reference["x_m"][k]).hypot(state[at::Y] - reference["y_m"][k]);
        let turned = (state[at::PSI] - reference["psi_rad"][k]).to_degrees().abs();
        largest.position_m = largest.position_m.max(away);
        largest.heading_deg = largest.heading_deg.max(turned);
    }
    println!(
        "{}: {:.2e} m, {:.2e} deg",
        file.file_name().unwrap_or_default().display(),
        largest.position_m,
        largest.heading_deg
    );
    largest
}

fn ship(name: &str) -> (sistership_model::Model, std::sync::Arc<sistership_model::Law>) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&model.law).expect("the law of a zoo model").clone();
    (model, law)
}

/// Ordered rudder of a turn executed at a time.
fn turn_at(execute_s: f64, rudder_deg: f64) -> impl Fn(f64, &[f64; 9]) -> f64 {
    move |t_s, _| if t_s >= execute_s - 1e-9 { rudder_deg.to_radians() } else { 0.0 }
}

/// Ordered rudder of a zigzag executed at a time: reversed at the first step at which the heading
/// has arrived.
fn zigzag_at(execute_s: f64, angle_deg: f64) -> impl Fn(f64, &[f64; 9]) -> f64 {
    let side = std::cell::Cell::new(1.0);
    move |t_s, state| {
        if t_s < execute_s - 1e-9 {
            return 0.0;
        }
        if side.get() * state[at::PSI] >= angle_deg.to_radians() {
            side.set(-side.get());
        }
        side.get() * angle_deg.to_radians()
    }
}

#[test]
fn sr108_follows_the_reference() {
    let Some(folder) = shared::data("sr108/reference") else { return };
    let (model, law) = ship("sr108");
    let sr108 = Ship::new(&model, &law).expect("a ready ship");
    for (knots, speed) in [
        ("16.3", 8.385_444_444_444_445),
        ("20.4", 10.494_666_666_666_67),
        ("24.7", 12.706_777_777_777_78),
    ] {
        for rudder in ["-7.5", "7.5"] {
            let file = folder.join(format!("turn_{knots}kn_{rudder}deg.csv"));
            let largest = follow(
                &sr108,
                &file,
                speed,
                f64::INFINITY,
                turn_at(70.0, rudder.parse().expect("a number")),
            );
            assert!(largest.position_m < 0.05 && largest.heading_deg < 0.01, "{}", file.display());
        }
    }
}

#[test]
fn mariner_follows_the_reference() {
    let Some(folder) = shared::data("mariner") else { return };
    let (model, law) = ship("mariner");
    let mariner = Ship::new(&model, &law).expect("a ready ship");
    let check = |name: &str, order: &dyn Fn(f64, &[f64; 9]) -> f64| {
        let largest = follow(&mariner, &folder.join(name), 7.7175, f64::INFINITY, order);
        assert!(largest.position_m < 0.5 && largest.heading_deg < 0.05, "{name}");
    };
    for rudder in [-20.0, 15.0, 35.0] {
        check(&format!("turn_{rudder}deg.csv"), &turn_at(10.0, rudder));
    }
    check("zigzag_10_10.csv", &zigzag_at(10.0, 10.0));
    check("zigzag_20_20.csv", &zigzag_at(10.0, 20.0));
}

#[test]
fn esso_tanker_follows_the_reference_deep_and_shallow() {
    let Some(folder) = shared::data("esso-tanker") else { return };
    let (model, law) = ship("esso-tanker");
    let check = |name: &str, depth_m: f64, order: &dyn Fn(f64, &[f64; 9]) -> f64| {
        let mut tanker = Ship::new(&model, &law).expect("a ready ship");
        tanker.set_depth(depth_m);
        let largest = follow(&tanker, &folder.join(name), 7.5, 600.0, order);
        assert!(largest.position_m < 0.5 && largest.heading_deg < 0.05, "{name}");
    };
    check("turn_-10deg_deep.csv", 200.0, &turn_at(10.0, -10.0));
    check("turn_10deg_deep.csv", 200.0, &turn_at(10.0, 10.0));
    check("turn_10deg_depth_1p5T.csv", 27.69, &turn_at(10.0, 10.0));
    check("zigzag_10_10_deep.csv", 200.0, &zigzag_at(10.0, 10.0));
    check("zigzag_10_10_depth_1p5T.csv", 27.69, &zigzag_at(10.0, 10.0));
}

/// The predictions quoted as EFD-NMRI in Mei 2019, Table 10: advance 3.31 L, tactical diameter 3.36
/// L.
#[test]
fn kvlcc2_turns_as_published() {
    for name in ["kvlcc2-7m", "kvlcc2"] {
        let (model, law) = ship(name);
        let kvlcc2 = Ship::new(&model, &law).expect("a ready ship");
        for rudder in [35.0, -35.0] {
            let metrics = simulate_turn(&kvlcc2, rudder, &ManoeuvreSettings::default())
                .expect("a turn")
                .metrics;
            let lengths = |m: Option<f64>| m.expect("a full turn") / kvlcc2.lpp_m();
            let (advance, diameter) =
                (lengths(metrics.advance_m), lengths(metrics.tactical_diameter_m));
            println!(
                "{name} {rudder:+} deg: advance {advance:.3} L, tactical diameter {diameter:.3} L"
            );
            assert!((advance / 3.31 - 1.0).abs() < 0.02 && (diameter / 3.36 - 1.0).abs() < 0.02);
        }
    }
}
