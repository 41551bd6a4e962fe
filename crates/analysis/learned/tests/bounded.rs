//! A branch never makes a simulation diverge, nor leave the physical range.

use crate::ships::{Foundation, learners, training};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;
use sistership_learned::{CorrectionWeights, corrected_ship};
use sistership_model::Model;
use sistership_model::branch::CorrectionMode;
use sistership_model::version::sha256_hex;
use sistership_simulation::state::{StateVector, straight_state};
use sistership_simulation::validity::find_excursion;
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship, Trajectory};

/// Sails random orders, each held for up to 2 L/U: the rudder to its stop, the revolutions from
/// nothing to a third more than those of the approach.
fn sail(ship: &Ship, seed: u64) -> Trajectory {
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let (speed, lengths_s) = (ship.approach_speed_m_s(), ship.lpp_m() / ship.approach_speed_m_s());
    let most: f64 = if seed.is_multiple_of(2) { 20.0 } else { 40.0 };
    let (mut order, mut until_s) = (HelmOrder { delta_rad: 0.0, n_rps: 0.0 }, -1.0);
    let bridge = |t_s: f64, _: &StateVector| {
        if t_s > until_s {
            let n_rps = ship.revolutions_at(speed) * rng.random_range(0.0..1.33);
            order = HelmOrder { delta_rad: rng.random_range(-most..most).to_radians(), n_rps };
            until_s = t_s + rng.random_range(0.0..2.0) * lengths_s;
        }
        Some(order)
    };
    let run = RunSettings {
        start: straight_state(speed),
        duration_s: 20.0 * lengths_s,
        step_s: 0.1 * lengths_s,
        method: Method::Rk4,
    };
    let mut track = Trajectory::default();
    ship.simulate_orders(run, &mut track, bridge)
        .unwrap_or_else(|stopped| panic!("{seed}: {stopped}"));
    track
}

/// Sails many, and answers the share of the time that they were outside the branch's domain.
fn sail_many(ship: &Ship, model: &Model, seeds: std::ops::Range<u64>) -> f64 {
    let count = seeds.end - seeds.start;
    let domain = &model.branch.as_ref().unwrap().domain;
    let outside = |seed| find_excursion(domain, &sail(ship, seed)).map_or(0.0, |left| left.share);
    seeds.into_par_iter().map(outside).sum::<f64>() / count as f64
}

#[test]
fn ten_thousand_random_runs_keep_to_the_physical_range() {
    let mut run = 0;
    for name in ["mariner", "kvlcc2-7m"] {
        let foundation = Foundation::of(name);
        // The foundation alone sails them all, or the test says nothing of branches.
        let alone = Ship::new(&foundation.model, &foundation.law).unwrap();
        (0..500_u64).into_par_iter().for_each(|seed| drop(sail(&alone, seed)));
        for learner in learners() {
            let (model, weights) = foundation.trained(&training(learner, CorrectionMode::Parallel));
            let joined = corrected_ship(&model, &foundation.law, &weights).unwrap();
            let outside = sail_many(&joined, &model, run..run + 1250);
            println!("{name}: outside the domain {:.0} % of the time", 100.0 * outside);
            assert!((0.05..0.95).contains(&outside), "{name}: {outside}");
            run += 1250;
        }
    }
    assert_eq!(run, 10_000);
}

/// Branches that always push as hard as they may, every way; what each holds is the greatest that
/// its training did.
#[test]
fn not_even_the_worst_weights_leave_the_physical_range() {
    for name in ["mariner", "kvlcc2-7m"] {
        let foundation = Foundation::of(name);
        let [.., network] = learners();
        for mode in [CorrectionMode::Parallel, CorrectionMode::Convert] {
            let (mut model, _) = foundation.trained(&training(network.clone(), mode));
            for signs in 0..8 {
                let of = |axis: i32| {
                    let push = if signs >> axis & 1 == 1 { 1e6 } else { -1e6 };
                    format!(r#"{{"perceptron":[{{"weights":[0,0,0,0],"biases":[{push:?}]}}]}}"#)
                };
                let text = format!(r#"{{"outputs":[{},{},{}]}}"#, of(0), of(1), of(2));
                let weights: CorrectionWeights = serde_json::from_str(&text).unwrap();
                let bytes = weights.to_bytes().unwrap();
                model.branch.iter_mut().for_each(|b| b.weights_sha256 = sha256_hex(&bytes));
                let joined = corrected_ship(&model, &foundation.law, &bytes).unwrap();
                (0..200_u64).into_par_iter().for_each(|seed| drop(sail(&joined, seed)));
            }
        }
    }
}
