//! Random manoeuvres of a ship that follows another law than the one that is fitted.

use std::collections::BTreeMap;

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::state::{
    RECORDED_CHANNELS, StateVector, Trajectory, at, straight_state,
};
use sistership_simulation::{HelmOrder, Method, Ship};
use sistership_tests::synthetic::replica;

const STEP_S: f64 = 0.1;
/// Rudder, deg, and revolutions by those of the approach; reversed ones would stop it, where the
/// MMG's primes end.
const RUDDER_DEG: f64 = 35.0;
const REVOLUTIONS: [f64; 2] = [0.3, 1.3];
/// Noise: velocities m/s, yaw rate rad/s, heading rad, position m.
const NOISE: [f64; 6] = [0.004, 0.004, 2e-4, 1e-3, 0.02, 0.02];

/// So many trials of so many seconds at 10 Hz.
pub fn trials(model: &Model, law: &Law, count: usize, duration_s: f64, seed: u64) -> Vec<Trial> {
    let ship = Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"));
    let one = |index: usize| {
        trial(&ship, &format!("random {seed}-{index}"), duration_s, &mut replica(seed, index))
    };
    (0..count).map(one).collect()
}

fn trial(ship: &Ship, name: &str, duration_s: f64, rng: &mut ChaCha12Rng) -> Trial {
    let approach_n = ship.revolutions_at(ship.approach_speed_m_s());
    let mut state = straight_state(rng.random_range(0.5..1.0) * ship.approach_speed_m_s());
    let mut order = HelmOrder { delta_rad: 0.0, n_rps: 0.8 * approach_n };
    let (mut n_rps, mut until) = (order.n_rps, [0.0; 2]);
    let mut track = Trajectory::default();
    let mut work = sistership_simulation::plant::PlantWorkspace::default();
    for k in 0..=(duration_s / STEP_S) as usize {
        let t_s = k as f64 * STEP_S;
        if t_s >= until[0] {
            order.delta_rad = rng.random_range(-RUDDER_DEG..RUDDER_DEG).to_radians();
            until[0] = t_s + rng.random_range(5.0..30.0);
        }
        if t_s >= until[1] {
            order.n_rps = rng.random_range(REVOLUTIONS[0]..REVOLUTIONS[1]) * approach_n;
            until[1] = t_s + rng.random_range(15.0..60.0);
        }
        // The engine follows its order in some seconds.
        n_rps += STEP_S / 3.0 * (order.n_rps - n_rps);
        track.push(t_s, state, n_rps);
        let now = HelmOrder { n_rps, ..order };
        state = Method::Rk4
            .advance_state(&state, STEP_S, |_, s| ship.rate_under(s, now, STEP_S, &mut work));
        ship.envelope()
            .check_state(t_s, &state)
            .unwrap_or_else(|stopped| panic!("{name}: {stopped}"));
    }
    measured(name, &track, rng)
}

fn measured(name: &str, track: &Trajectory, rng: &mut ChaCha12Rng) -> Trial {
    let mut channels: BTreeMap<Channel, Vec<f64>> = BTreeMap::new();
    for (&(channel, place), noise) in RECORDED_CHANNELS[..6].iter().zip(NOISE) {
        let mut noisy =
            |state: &StateVector| state[place] + noise * rng.sample::<f64, _>(StandardNormal);
        channels.insert(channel, track.states.iter().map(&mut noisy).collect());
    }
    channels.insert(Channel::Delta, track.state_column(at::DELTA));
    channels.insert(Channel::N, track.n_rps.clone());
    Trial { name: name.to_owned(), t_s: track.t_s.clone(), channels, ..Trial::default() }
}
