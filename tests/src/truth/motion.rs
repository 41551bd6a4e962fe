//! Equations of motion that every ship of the truth shares, and how it is sailed.

use sistership_simulation::Method;
use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};

use super::dimensions::Dimensions;

/// Step of the integration, s.
pub const STEP_S: f64 = 0.1;
/// Rudder stop, rad.
const STOP_RAD: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// A ship by equations of its own.
pub trait Truth: Sync {
    /// Its size.
    fn dimensions(&self) -> &Dimensions;
    /// Accelerations of surge, sway (m/s2), yaw and roll (rad/s2) at a state, whose rudder angle is
    /// the actual one.
    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4];
    /// Accelerations at revolutions of either shaft (1/s), and the rates of change of these, 1/s2:
    /// none for ships whose revolutions are held.
    fn powered_accelerations(&self, state: &StateVector, n_rps: [f64; 2]) -> ([f64; 4], [f64; 2]) {
        (self.accelerations(state, n_rps[0]), [0.0; 2])
    }
    /// Step of the integration, s.
    fn step_s(&self) -> f64 {
        STEP_S
    }
    /// Its mass and the water's.
    fn inertia(&self) -> &Inertia;
    /// Revolutions that keep the approach speed, 1/s.
    fn revolutions_rps(&self) -> f64;
    /// Rudder rate, rad/s.
    fn rudder_rate_rad_s(&self) -> f64;
}

/// Rigid body and added mass about midship, in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Mass and added mass in surge, kg.
    pub surge_kg: f64,
    /// Mass and added mass in sway, kg.
    pub sway_kg: f64,
    /// Coupling of sway force to yaw acceleration, kg m.
    pub sway_by_yaw_kg_m: f64,
    /// Coupling of yaw moment to sway acceleration, kg m.
    pub yaw_by_sway_kg_m: f64,
    /// Moment of inertia with the water's, kg m2.
    pub yaw_kg_m2: f64,
    /// First moment of mass, kg m.
    pub moment_kg_m: f64,
}

impl Inertia {
    /// Accelerations under forces of surge, sway (N) and yaw (N m) on a body that moves at `u, v,
    /// r`.
    pub fn accelerations(&self, [x, y, n]: [f64; 3], [u, v, r]: [f64; 3]) -> [f64; 3] {
        let surge = x + self.mass_kg * v * r + self.moment_kg_m * r * r;
        let sway = y - self.mass_kg * u * r;
        let yaw = n - self.moment_kg_m * u * r;
        let (a, b, c, d) =
            (self.sway_kg, self.sway_by_yaw_kg_m, self.yaw_by_sway_kg_m, self.yaw_kg_m2);
        let determinant = a * d - b * c;
        let across = [(d * sway - b * yaw) / determinant, (a * yaw - c * sway) / determinant];
        [surge / self.surge_kg, across[0], across[1]]
    }

    /// Accelerations under forces from outside alone.
    pub fn answers(&self, forces: [f64; 3]) -> [f64; 3] {
        self.accelerations(forces, [0.0; 3])
    }
}

/// Rate of change of the state under an ordered rudder angle (rad).
fn rate(ship: &dyn Truth, state: &StateVector, order_rad: f64, n_rps: f64) -> StateVector {
    rate_under(ship, state, order_rad, ship.accelerations(state, n_rps))
}

/// The same by accelerations that are known.
pub(super) fn rate_under(
    ship: &dyn Truth,
    state: &StateVector,
    order_rad: f64,
    [surge, sway, yaw, roll]: [f64; 4],
) -> StateVector {
    let (sin, cos) = state[at::PSI].sin_cos();
    let (u, across) = (state[at::U], state[at::V] * state[at::PHI].cos());
    let mut rate = StateVector::zeros();
    rate[at::U] = surge;
    rate[at::V] = sway;
    rate[at::R] = yaw;
    rate[at::P] = roll;
    rate[at::PHI] = state[at::P];
    rate[at::PSI] = state[at::R] * state[at::PHI].cos();
    rate[at::X] = u * cos - across * sin;
    rate[at::Y] = u * sin + across * cos;
    rate[at::DELTA] = rudder_rate(ship, state[at::DELTA], order_rad);
    rate
}

/// A gear that moves at its full rate and slows down over the last step.
fn rudder_rate(ship: &dyn Truth, angle_rad: f64, order_rad: f64) -> f64 {
    let order = order_rad.clamp(-STOP_RAD, STOP_RAD);
    let limit = ship.rudder_rate_rad_s();
    ((order - angle_rad) / ship.step_s()).clamp(-limit, limit)
}

/// The state one step later.
pub fn step(ship: &dyn Truth, state: &StateVector, order_rad: f64, n_rps: f64) -> StateVector {
    Method::Rk4.advance_state(state, STEP_S, |_, at| rate(ship, at, order_rad, n_rps))
}

/// Sails from straight running at the approach speed: one sample a step; `order` gives the rudder,
/// rad, at a time and state.
pub fn sail(
    ship: &dyn Truth,
    duration_s: f64,
    n_rps: f64,
    order: impl FnMut(f64, &StateVector) -> f64,
) -> Trajectory {
    sail_from(ship, straight_state(ship.dimensions().speed_m_s), duration_s, n_rps, order)
}

/// The same from a state.
pub fn sail_from(
    ship: &dyn Truth,
    start: StateVector,
    duration_s: f64,
    n_rps: f64,
    mut order: impl FnMut(f64, &StateVector) -> f64,
) -> Trajectory {
    let mut track = Trajectory::default();
    let mut state = start;
    for k in 0..=(duration_s / STEP_S).round() as usize {
        let t_s = k as f64 * STEP_S;
        track.push(t_s, state, n_rps);
        state = step(ship, &state, order(t_s, &state), n_rps);
    }
    track
}
