//! Responses of a ship in regular waves.

use serde::{Deserialize, Serialize};

use super::heave_pitch::{heave, pitch};
use super::hull::WaveHull;
use super::roll::roll;

/// Motion of a ship in waves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Heave, m.
    Heave,
    /// Pitch, rad.
    Pitch,
    /// Roll, rad.
    Roll,
}

/// Response amplitude operators of a ship.
pub trait Responses {
    /// Amplitude of a motion per wave amplitude, m/m or rad/m. `omega` is the wave frequency,
    /// rad/s; `beta` the direction of wave travel from the bow, rad: pi is a head sea.
    fn response(&self, motion: Motion, omega: f64, beta: f64) -> f64;
}

impl WaveHull {
    /// All motions.
    pub const MOTIONS: [Motion; 3] = [Motion::Heave, Motion::Pitch, Motion::Roll];
}

/// Responses by closed forms.
impl Responses for WaveHull {
    fn response(&self, motion: Motion, omega: f64, beta: f64) -> f64 {
        match motion {
            Motion::Heave => heave(self, omega, beta),
            Motion::Pitch => pitch(self, omega, beta),
            Motion::Roll => roll(self, omega, beta),
        }
    }
}
