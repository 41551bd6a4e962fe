//! Responses of a ship among waves.

use serde::{Deserialize, Serialize};

use super::heave_pitch::{heave, pitch};
use super::hull::WaveHull;
use super::roll::roll;

/// A motion in waves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// m.
    Heave,
    /// rad.
    Pitch,
    /// rad.
    Roll,
}

/// Whatever answers how a ship moves among waves.
pub trait Responses {
    /// Amplitude of a motion by that of a wave, m/m or rad/m. `omega` is the wave's frequency,
    /// rad/s; `beta` where it goes from the bow, rad: pi is a head sea.
    fn response(&self, motion: Motion, omega: f64, beta: f64) -> f64;
}

impl WaveHull {
    /// Every motion.
    pub const MOTIONS: [Motion; 3] = [Motion::Heave, Motion::Pitch, Motion::Roll];
}

/// By closed forms.
impl Responses for WaveHull {
    fn response(&self, motion: Motion, omega: f64, beta: f64) -> f64 {
        match motion {
            Motion::Heave => heave(self, omega, beta),
            Motion::Pitch => pitch(self, omega, beta),
            Motion::Roll => roll(self, omega, beta),
        }
    }
}
