//! Responses of a ship in regular waves.

use serde::{Deserialize, Serialize};

use super::heave_pitch::{heave_response, pitch_response};
use super::hull::WaveHull;
use super::roll::roll_response;

/// Motion of a ship in waves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WaveMotion {
    /// Heave, m.
    Heave,
    /// Pitch, rad.
    Pitch,
    /// Roll, rad.
    Roll,
}

/// Response amplitude operators of a ship.
pub trait ResponseOperator {
    /// Amplitude of a motion per wave amplitude, m/m or rad/m. `omega` is the wave frequency,
    /// rad/s; `beta` the direction of wave travel from the bow, rad: pi is a head sea.
    fn response_amplitude(&self, motion: WaveMotion, omega: f64, beta: f64) -> f64;
}

impl WaveHull {
    /// All motions.
    pub const MOTIONS: [WaveMotion; 3] = [WaveMotion::Heave, WaveMotion::Pitch, WaveMotion::Roll];
}

/// Responses by closed forms.
impl ResponseOperator for WaveHull {
    fn response_amplitude(&self, motion: WaveMotion, omega: f64, beta: f64) -> f64 {
        match motion {
            WaveMotion::Heave => heave_response(self, omega, beta),
            WaveMotion::Pitch => pitch_response(self, omega, beta),
            WaveMotion::Roll => roll_response(self, omega, beta),
        }
    }
}
