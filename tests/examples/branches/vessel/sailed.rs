//! A scenario sailed, and recorded once a second with the motion of wave frequency.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Method;
use sistership_simulation::state::{StateVector, at};

use super::hull::Hull;
use super::seas::Seas;
use super::weather::Weather;

/// Step, s, and steps from one sample to the next.
const STEP_S: f64 = 0.2;
const STEPS: usize = 5;
/// How fast the thrusters change, rad/s (the zoo's figure) and rps/s (chosen: ten seconds to all).
const TURN_RAD_S: f64 = 0.174533;
const REV_RPS_S: f64 = 0.3;

/// From the random numbers of a scenario to those of its seas.
const SEAS: u64 = 1 << 32;

/// Orders at a time, s: revolutions (1/s) and angle (rad, positive to starboard).
pub type Bridge<'a> = &'a dyn Fn(f64) -> [f64; 2];

/// Where and how fast a scenario begins.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    pub u_m_s: f64,
    pub psi_rad: f64,
    pub n_rps: f64,
    pub delta_rad: f64,
}

/// Sails a ship in a weather; the trial that its instruments record from `from_s` on. Times and the
/// weather are those of the virtual ship, for another by Froude's law.
pub fn sail(
    hull: &Hull,
    weather: &Weather,
    start: Start,
    [from_s, to_s]: [f64; 2],
    seed: u64,
    bridge: Bridge<'_>,
) -> Trial {
    let weather = &weather.of_size(hull);
    let (seas, time) = (Seas::new(weather, seed + SEAS), hull.scale().sqrt());
    let mut state = StateVector::zeros();
    (state[at::U], state[at::PSI], state[at::DELTA]) =
        (start.u_m_s, start.psi_rad, start.delta_rad);
    let (mut n_rps, mut log) = (start.n_rps, Log::default());
    for step in 0..=(to_s / STEP_S).round() as usize {
        let t_s = step as f64 * STEP_S;
        if step % STEPS == 0 && t_s >= from_s {
            log.read(hull, &seas, time * t_s, &state, n_rps);
        }
        let [n_order, delta_order] = bridge(t_s);
        let towards = |order: f64, now: f64, limit: f64| {
            now + (order - now).clamp(-limit * STEP_S, limit * STEP_S)
        };
        n_rps = towards(n_order, n_rps, hull.revolutions() * REV_RPS_S);
        state[at::DELTA] = towards(delta_order, state[at::DELTA], TURN_RAD_S);
        state = Method::Rk4
            .advance_state(&state, time * STEP_S, |_, at| rate(hull, weather, at, n_rps));
    }
    log.trial(weather, seed)
}

fn rate(hull: &Hull, weather: &Weather, state: &StateVector, n_rps: f64) -> StateVector {
    let velocities = [state[at::U], state[at::V], state[at::R]];
    let (sin, cos) = state[at::PSI].sin_cos();
    let found = weather.accelerations(hull, state[at::PSI], velocities, n_rps, state[at::DELTA]);
    let mut rate = StateVector::zeros();
    [rate[at::U], rate[at::V], rate[at::R]] = found;
    rate[at::PSI] = state[at::R];
    rate[at::X] = state[at::U] * cos - state[at::V] * sin;
    rate[at::Y] = state[at::U] * sin + state[at::V] * cos;
    rate
}

/// What the instruments read.
#[derive(Default)]
struct Log {
    t_s: Vec<f64>,
    columns: BTreeMap<Channel, Vec<f64>>,
}

impl Log {
    fn read(&mut self, hull: &Hull, seas: &Seas, t_s: f64, state: &StateVector, n_rps: f64) {
        let place = |later_s: f64| {
            let (sin, cos) = state[at::PSI].sin_cos();
            let (u, v) = (state[at::U], state[at::V]);
            let north = state[at::X] + later_s * (u * cos - v * sin);
            let east = state[at::Y] + later_s * (u * sin + v * cos);
            let psi = state[at::PSI] + later_s * state[at::R];
            let moved = seas.motion(hull, t_s + later_s, [north, east, psi]);
            [moved[0], moved[1], moved[2]]
        };
        let half = 0.05;
        let (before, now, after) = (place(-half), place(0.0), place(half));
        let speed: [f64; 3] = std::array::from_fn(|k| (after[k] - before[k]) / (2.0 * half));
        let psi = state[at::PSI] + now[2];
        let (sin, cos) = psi.sin_cos();
        let read = [
            (Channel::X, state[at::X] + now[0]),
            (Channel::Y, state[at::Y] + now[1]),
            (Channel::Psi, psi),
            (Channel::U, state[at::U] + speed[0] * cos + speed[1] * sin),
            (Channel::V, state[at::V] - speed[0] * sin + speed[1] * cos),
            (Channel::R, state[at::R] + speed[2]),
            (Channel::Delta, state[at::DELTA]),
            (Channel::N, n_rps),
        ];
        self.t_s.push(t_s);
        read.into_iter().for_each(|(channel, value)| {
            self.columns.entry(channel).or_default().push(value);
        });
    }

    fn trial(self, weather: &Weather, seed: u64) -> Trial {
        let mut channels = self.columns;
        let wind = [
            (Channel::WindSpeed, weather.wind_m_s),
            (Channel::WindFrom, weather.towards_rad + std::f64::consts::PI),
        ];
        for (channel, value) in wind {
            channels.insert(channel, vec![value; self.t_s.len()]);
        }
        Trial { name: format!("scenario {seed}"), t_s: self.t_s, channels, ..Trial::default() }
    }
}
