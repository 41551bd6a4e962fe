//! What is recorded of the true ship.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, Normal};
use sistership_model::Trial;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;
use sistership_simulation::Trajectory;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{StateVector, at};

use super::sailing::{N_RPS, STEP_S, Sailing, TrueShip};

/// One sample of so many steps: 2 Hz.
pub const STRIDE: usize = 5;

/// What is recorded of the state, and the standard deviation of its noise, SI: as in
/// `../shared/data/sr108/examples`.
pub const NOISE: [(Channel, usize, f64); 9] = [
    (Channel::X, at::X, 0.3),
    (Channel::Y, at::Y, 0.3),
    (Channel::Psi, at::PSI, 3.5e-4),
    (Channel::U, at::U, 2.5e-3),
    (Channel::V, at::V, 3e-3),
    (Channel::R, at::R, 5e-5),
    (Channel::Phi, at::PHI, 3.5e-4),
    (Channel::P, at::P, 1.8e-4),
    (Channel::Delta, at::DELTA, 3.6e-4),
];
const REVOLUTIONS_NOISE_RPS: f64 = 8.5e-4;
const WIND_SPEED_NOISE_M_S: f64 = 0.2;
const WIND_FROM_NOISE_RAD: f64 = 0.06;

/// Sails and records a trial.
pub fn record(ship: &TrueShip, sailing: &Sailing, seed: u64) -> Trial {
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let steps = (super::sailing::DURATION_S / STEP_S).round() as usize + 1;
    let wind = ship.wind.map_or_else(Vec::new, |wind| wind.speeds(steps, STEP_S, &mut rng));
    let track = ship.sail(sailing, &wind);
    let said = said(ship, &track, &wind);
    let mut noisy = |values: Vec<f64>, deviation: f64| -> Vec<f64> {
        let noise = Normal::new(0.0, deviation).unwrap();
        values.into_iter().map(|value| value + noise.sample(&mut rng)).collect()
    };
    let mut channels: BTreeMap<Channel, Vec<f64>> = NOISE
        .iter()
        .map(|&(channel, index, sd)| (channel, noisy(said.iter().map(|s| s[index]).collect(), sd)))
        .collect();
    channels.insert(Channel::N, noisy(vec![N_RPS; said.len()], REVOLUTIONS_NOISE_RPS));
    if ship.has_wind_sensor {
        let speed =
            (0..steps).step_by(STRIDE).map(|k| wind.get(k).copied().unwrap_or(0.0)).collect();
        let from_rad = ship.wind.map_or(0.0, |wind| wind.from_rad);
        channels.insert(Channel::WindSpeed, noisy(speed, WIND_SPEED_NOISE_M_S));
        channels.insert(Channel::WindFrom, noisy(vec![from_rad; said.len()], WIND_FROM_NOISE_RAD));
    }
    Trial {
        name: sailing.name(),
        t_s: track.t_s.iter().copied().step_by(STRIDE).collect(),
        channels,
        manoeuvre: Some(sailing.name()),
        velocity: VelocityFrame::Ground,
        ..Trial::default()
    }
}

/// What the instruments say without noise, sample by sample.
pub fn said(ship: &TrueShip, track: &Trajectory, wind: &[f64]) -> Vec<StateVector> {
    let mut work = PlantWorkspace::default();
    let mut one = |k: usize| {
        let mut said = ship.says(track.t_s[k], &track.states[k], wind.get(k).copied(), &mut work);
        if ship.delay_s != 0.0 {
            // A gyro compass that gives heading and yaw rate is late.
            let late = past(track, k, ship.delay_s);
            (said[at::PSI], said[at::R]) = (late[at::PSI], late[at::R]);
        }
        said
    };
    (0..track.t_s.len()).step_by(STRIDE).map(&mut one).collect()
}

/// The state some time before step `k`; before the trial it ran steadily.
fn past(track: &Trajectory, k: usize, delay_s: f64) -> StateVector {
    let place = (k as f64 - delay_s / STEP_S).clamp(0.0, (track.states.len() - 1) as f64);
    let (before, w) = (place.floor() as usize, place.fract());
    let after = (before + 1).min(track.states.len() - 1);
    track.states[before] * (1.0 - w) + track.states[after] * w
}
