//! Drift in short waves: a wall that reflects them all is pushed along its normal by `rho g a^2/2
//! sin^2` of the angle between wave and wall on each metre, the momentum of the wave that is turned
//! back. Here for a waterline of straight sides and blunt ends.

use sistership_simulation::state::{StateVector, at};

use super::super::dimensions::{Dimensions, GRAVITY};

/// Length of the waves by that of the ship, chosen.
const WAVELENGTH: f64 = 1.0;
/// How blunt the ends are: a share of the breadth that reflects, chosen.
const BLUNT: f64 = 0.5;
/// Lever of the sway force by length in bow waves, chosen.
const LEVER: f64 = 0.06;

/// Waves of one amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waves {
    /// Amplitude, m.
    pub amplitude_m: f64,
    /// Where they come from, rad.
    pub from_rad: f64,
}

impl Waves {
    /// Surge, sway (N) and yaw (N m); the force goes with the number of waves that are met, `1 +
    /// omega U cos(beta)/g`.
    pub fn forces(&self, ship: &Dimensions, state: &StateVector) -> [f64; 3] {
        let (sin, cos) = (self.from_rad - state[at::PSI]).sin_cos();
        let omega = (std::f64::consts::TAU * GRAVITY / (WAVELENGTH * ship.lpp_m)).sqrt();
        let met = (1.0 + omega * state[at::U] * cos / GRAVITY).max(0.0);
        let push = 0.5 * ship.density_kg_m3 * GRAVITY * self.amplitude_m.powi(2) * met;
        let sway = -push * ship.lpp_m * sin * sin.abs();
        let surge = -push * BLUNT * ship.beam_m * cos * cos.abs();
        [surge, sway, LEVER * ship.lpp_m * cos * sway]
    }
}
