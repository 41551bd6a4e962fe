//! Known coefficients come back: trials made with a law, refined with the same law from a wrong
//! source.

use rand::{RngExt, SeedableRng};
use sistership_identification::refine::{RefinementSettings, RefinementSpec, TuningRange, refine};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, at};
use sistership_simulation::{Method, Trajectory};

use super::{model, ready};

fn trial(name: &str, track: &Trajectory) -> Trial {
    let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
    let mut channels: std::collections::BTreeMap<_, _> =
        columns.map(|&(channel, index)| (channel, track.state_column(index))).collect();
    channels.insert(Channel::N, track.n_rps.clone());
    Trial { name: name.into(), t_s: track.t_s.clone(), channels, ..Trial::default() }
}

/// Noise-free trials by explicit Euler, for which one-step differences are exact.
fn trials(model: &Model, law: &sistership_model::Law) -> Vec<Trial> {
    let ship = ready(model, law);
    let settings = ManoeuvreSettings {
        step_s: Some(0.25),
        method: Method::Euler,
        duration_s: Some(400.0),
        ..ManoeuvreSettings::default()
    };
    let zigzags = [(10.0, 10.0), (-20.0, 20.0), (30.0, 10.0)].map(|(rudder, switch)| {
        simulate_zigzag(&ship, rudder, switch, &settings).expect("a zigzag").track
    });
    let turns =
        [15.0, -30.0].map(|rudder| simulate_turn(&ship, rudder, &settings).expect("a turn").track);
    zigzags
        .iter()
        .chain(&turns)
        .enumerate()
        .map(|(k, track)| trial(&format!("trial {k}"), track))
        .collect()
}

#[test]
fn coefficients_are_recovered_from_noise_free_trials() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    for name in ["mariner", "kvlcc2"] {
        let (truth, law) = model(name);
        let trials = trials(&truth, &law);
        let trials: Vec<&Trial> = trials.iter().collect();
        let mut rng = rand_chacha::ChaCha12Rng::seed_from_u64(7);
        let mut source = truth.clone();
        source
            .coefficients
            .values_mut()
            .for_each(|quantity| quantity.value *= rng.random_range(0.8..1.2));
        let settings = RefinementSettings {
            ranges: vec![TuningRange { lambda_min: 1e-14, lambda_max: 1e-14, alpha_max: 0.0 }],
            difference_s: Some(0.25),
            restart_s: Some(1e9),
            ..RefinementSettings::default()
        };
        let target = zoo.vessel(name).expect("in the zoo");
        let request = RefinementSpec {
            target,
            source: &source,
            source_law: None,
            law: &law,
            trials: &trials,
            population: &[],
            settings: &settings,
        };
        let refined =
            refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{name}: {error}"));
        for linear in ["Y_v", "Y_r", "N_v", "N_r"] {
            let (found, true_value) =
                (refined.model.coefficient(linear), truth.coefficient(linear));
            assert!(
                (found / true_value - 1.0).abs() < 1e-3,
                "{name} {linear}: {found} against {true_value}"
            );
        }
        let (before, after) = (refined.held_out.source["psi"], refined.held_out.refined["psi"]);
        // What remains is the replay's Runge-Kutta against the truth's Euler, not the coefficients.
        assert!(after < 0.05 * before, "{name}: heading error {before} -> {after}");
    }
}
