//! Forces that a ship's law does not have.

use sistership_simulation::state::{StateVector, at, straight_state};

use super::super::motion::Truth;
use super::depth::Depth;
use super::waves::Waves;

/// Thrust that is gained as the ship slows down at constant revolutions, by that lost of the speed,
/// chosen.
const SLOWED: f64 = 0.8;

/// One of them; sizes are by the ship's own where not said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Force {
    /// More resistance: a share of that at the approach speed, and the power of the speed by which
    /// it grows.
    Resistance(f64, f64),
    /// Shallow water.
    Depth(Depth),
    /// Drift in waves.
    Waves(Waves),
    /// Side force by thrust, and moment by thrust and length.
    Propeller(f64, f64),
    /// The same at any speed.
    PropellerWalk(f64, f64),
    /// A share of the thrust is lost from half time on.
    ThrustLost(f64),
    /// A yaw acceleration by `(U/L)^2` that oscillates with a period of so many `L/U`.
    Oscillating(f64, f64),
    /// A sway acceleration by `U^2/L` that goes with the cosine of three times the heading.
    ByHeading(f64),
}

/// When and where a force acts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment<'a> {
    /// Since the start, s.
    pub t_s: f64,
    /// Of the trial's duration.
    pub share: f64,
    /// Over the ground.
    pub state: &'a StateVector,
    /// Through the water: surge, sway, yaw.
    pub through_water: [f64; 3],
}

impl Force {
    /// Accelerations of surge, sway (m/s2) and yaw (rad/s2).
    pub(super) fn accelerations(&self, ship: &dyn Truth, now: &Moment<'_>) -> [f64; 3] {
        let size = ship.dimensions();
        let (speed, time_s) = (size.speed_m_s, size.length_time_s());
        let by_force = |forces: [f64; 3]| ship.inertia().answers(forces);
        let ahead = now.through_water[0].max(0.0) / speed;
        match *self {
            Self::Resistance(share, power) => {
                by_force([-share * resistance_n(ship) * ahead.powf(power), 0.0, 0.0])
            }
            Self::Depth(depth) => by_force(depth.forces(size, now.through_water)),
            Self::Waves(waves) => by_force(waves.forces(size, now.state)),
            Self::Propeller(side, moment) => {
                let thrust_n = resistance_n(ship) * (1.0 + SLOWED * (1.0 - ahead));
                by_force([0.0, side * thrust_n, moment * size.lpp_m * thrust_n])
            }
            Self::PropellerWalk(side, moment) => {
                let thrust_n = resistance_n(ship);
                by_force([0.0, side * thrust_n, moment * size.lpp_m * thrust_n])
            }
            Self::ThrustLost(share) => {
                let lost = if now.share < 0.5 { 0.0 } else { share };
                by_force([-lost * resistance_n(ship), 0.0, 0.0])
            }
            Self::Oscillating(amplitude, period) => {
                let phase = std::f64::consts::TAU * now.t_s / (period * time_s);
                [0.0, 0.0, amplitude * phase.sin() / time_s.powi(2)]
            }
            Self::ByHeading(size) => {
                [0.0, size * speed / time_s * (3.0 * now.state[at::PSI]).cos(), 0.0]
            }
        }
    }
}

/// Resistance at the approach speed, N: by how the ship slows down when its propeller stops.
pub fn resistance_n(ship: &dyn Truth) -> f64 {
    let state = straight_state(ship.dimensions().speed_m_s);
    -ship.accelerations(&state, 0.0)[0] * ship.inertia().surge_kg
}
