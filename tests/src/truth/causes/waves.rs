//! Drift in short waves: a wall that reflects them all is pushed along its normal by `rho g a^2/2
//! sin^2` of the angle between wave and wall on each metre, the momentum of the wave that is turned
//! back. Here for a waterline of straight sides and blunt ends.

use sistership_simulation::state::{StateVector, at};

use super::super::dimensions::{Dimensions, GRAVITY};

/// Length of the waves by that of the ship, chosen.
const WAVELENGTH: f64 = 1.0;
/// The same of the waves of [`DriftAuthor::Daidola`], chosen as short enough to drift abeam.
const SHORT: f64 = 0.5;
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
    /// Whose forces they have.
    pub author: DriftAuthor,
}

/// Authors of drift forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriftAuthor {
    /// A wall that reflects, as above.
    Wall,
    /// Daidola et al. (1986), A simulation program for vessel's maneuvering at slow speeds (not
    /// seen; polynomials as later papers quote them, not checked against any).
    Daidola,
}

impl Waves {
    /// Surge, sway (N) and yaw (N m); the force goes with the number of waves that are met, `1 +
    /// omega U cos(beta)/g`.
    pub fn forces(&self, ship: &Dimensions, state: &StateVector) -> [f64; 3] {
        let (sin, cos) = (self.from_rad - state[at::PSI]).sin_cos();
        if self.author == DriftAuthor::Daidola {
            return self.by_angle(ship, [sin, cos]);
        }
        let omega = (std::f64::consts::TAU * GRAVITY / (WAVELENGTH * ship.lpp_m)).sqrt();
        let met = (1.0 + omega * state[at::U] * cos / GRAVITY).max(0.0);
        let push = 0.5 * ship.density_kg_m3 * GRAVITY * self.amplitude_m.powi(2) * met;
        let sway = -push * ship.lpp_m * sin * sin.abs();
        let surge = -push * BLUNT * ship.beam_m * cos * cos.abs();
        [surge, sway, LEVER * ship.lpp_m * cos * sway]
    }

    /// Forces by sine and cosine of the angle, with polynomials of the wavelength by the length.
    fn by_angle(&self, ship: &Dimensions, [sin, cos]: [f64; 2]) -> [f64; 3] {
        let polynomial =
            |[a, b, c, d]: [f64; 4]| a + b * SHORT + c * SHORT.powi(2) + d * SHORT.powi(3);
        let surge = polynomial([0.05, -0.2, 0.75, -0.51]);
        let sway = polynomial([0.46, 6.83, -15.65, 8.44]);
        let yaw = polynomial([-0.11, 0.68, -0.79, 0.21]);
        let push = 0.5 * ship.density_kg_m3 * GRAVITY * ship.lpp_m * self.amplitude_m.powi(2);
        [-push * surge * cos, -push * sway * sin, -push * ship.lpp_m * yaw * sin]
    }
}
