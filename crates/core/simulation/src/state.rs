//! State of a ship in motion.

use nalgebra::SVector;
use sistership_model::trial::Channel;

use crate::tape::LaneValues;

/// State vector: `u, v, r, p, phi, psi, x, y, delta` in SI units and radians; `delta` is the actual
/// rudder angle.
pub type StateVector = SVector<f64, 9>;

/// States of ships in lockstep: by component, by ship.
pub type LaneStates<const N: usize> = [LaneValues<N>; 9];

/// State of one of several ships.
pub fn lane_of<const N: usize>(states: &LaneStates<N>, lane: usize) -> StateVector {
    StateVector::from_fn(|place, _| states[place][lane])
}

/// Sets the state of one of several ships.
pub fn set_lane<const N: usize>(states: &mut LaneStates<N>, lane: usize, state: &StateVector) {
    states.iter_mut().zip(state.iter()).for_each(|(lanes, value)| lanes[lane] = *value);
}

/// Places in the state vector.
pub mod at {
    /// Surge velocity, m/s.
    pub const U: usize = 0;
    /// Sway velocity, m/s.
    pub const V: usize = 1;
    /// Yaw rate, rad/s.
    pub const R: usize = 2;
    /// Roll rate, rad/s.
    pub const P: usize = 3;
    /// Roll angle, rad.
    pub const PHI: usize = 4;
    /// Heading, rad.
    pub const PSI: usize = 5;
    /// Position north, m.
    pub const X: usize = 6;
    /// Position east, m.
    pub const Y: usize = 7;
    /// Rudder angle, rad.
    pub const DELTA: usize = 8;
}

/// Channels of a trial that record the state, with their places in it: velocities, heading,
/// position, then roll.
pub const RECORDED_CHANNELS: [(Channel, usize); 8] = [
    (Channel::U, at::U),
    (Channel::V, at::V),
    (Channel::R, at::R),
    (Channel::Psi, at::PSI),
    (Channel::X, at::X),
    (Channel::Y, at::Y),
    (Channel::Phi, at::PHI),
    (Channel::P, at::P),
];

/// Speed, m/s: the magnitude of the horizontal velocity.
pub fn horizontal_speed(state: &StateVector) -> f64 {
    state[at::U].hypot(state[at::V])
}

/// State of straight running at a speed, heading north.
pub fn straight_state(speed_m_s: f64) -> StateVector {
    let mut state = StateVector::zeros();
    state[at::U] = speed_m_s;
    state
}

/// States over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    /// Time, s.
    pub t_s: Vec<f64>,
    /// The state at each time.
    pub states: Vec<StateVector>,
    /// Propeller revolutions at each time, 1/s.
    pub n_rps: Vec<f64>,
}

impl Trajectory {
    /// One component over time.
    pub fn state_column(&self, index: usize) -> Vec<f64> {
        self.states.iter().map(|state| state[index]).collect()
    }

    /// Adds a sample.
    pub fn push(&mut self, t_s: f64, state: StateVector, n_rps: f64) {
        self.t_s.push(t_s);
        self.states.push(state);
        self.n_rps.push(n_rps);
    }

    /// Appends the samples of another trajectory.
    pub fn append(&mut self, other: Self) {
        self.t_s.extend(other.t_s);
        self.states.extend(other.states);
        self.n_rps.extend(other.n_rps);
    }

    /// The last state.
    pub fn last(&self) -> Option<&StateVector> {
        self.states.last()
    }
}
