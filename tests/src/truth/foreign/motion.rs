//! State and orders of a craft.

use sistership_simulation::StateVector;
use sistership_simulation::state::{at, straight_state};

/// Shafts of a craft at most.
pub const SHAFTS: usize = 2;

/// Rigid-body state, angle of what steers (in the place of the rudder angle), and revolutions of
/// the shafts; also the rate of change of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Velocities, angles and position.
    pub body: StateVector,
    /// Revolutions of the shafts, 1/s; a single shaft is the first.
    pub n_rps: [f64; SHAFTS],
}

/// Orders from the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orders {
    /// Angle of what steers, rad, positive turns to starboard.
    pub angle_rad: f64,
    /// Revolutions of the shafts, 1/s.
    pub n_rps: [f64; SHAFTS],
}

impl Motion {
    /// Straight running at a speed (m/s) and revolutions.
    pub fn straight(speed_m_s: f64, n_rps: [f64; SHAFTS]) -> Self {
        Self { body: straight_state(speed_m_s), n_rps }
    }

    /// Surge, sway (m/s) and yaw (rad/s) velocity.
    pub fn velocities(&self) -> [f64; 3] {
        [at::U, at::V, at::R].map(|place| self.body[place])
    }

    /// The state after a time (s) at a rate of change.
    pub fn advance(&self, rate: &Self, time_s: f64) -> Self {
        let n_rps = std::array::from_fn(|k| self.n_rps[k] + time_s * rate.n_rps[k]);
        Self { body: self.body + rate.body * time_s, n_rps }
    }

    /// The state a step (s) later by the Runge-Kutta method of fourth order; `rate` is that of a
    /// state at a fraction of the step.
    pub fn runge_kutta_step(&self, step_s: f64, mut rate: impl FnMut(f64, &Self) -> Self) -> Self {
        let first = rate(0.0, self);
        let second = rate(0.5, &self.advance(&first, 0.5 * step_s));
        let third = rate(0.5, &self.advance(&second, 0.5 * step_s));
        let fourth = rate(1.0, &self.advance(&third, step_s));
        self.advance(&Self::runge_kutta_mean(&[first, second, third, fourth]), step_s)
    }

    /// The mean of four rates with the weights of the Runge-Kutta method.
    fn runge_kutta_mean(rates: &[Self; 4]) -> Self {
        let [a, b, c, d] = rates;
        let body = (a.body + (b.body + c.body) * 2.0 + d.body) / 6.0;
        let mean = |k: usize| (a.n_rps[k] + 2.0 * (b.n_rps[k] + c.n_rps[k]) + d.n_rps[k]) / 6.0;
        Self { body, n_rps: std::array::from_fn(mean) }
    }
}
