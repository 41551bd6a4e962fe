//! What the closed-form responses take of a ship.

use serde::{Deserialize, Serialize};

/// A ship at rest among waves, SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveHull {
    /// Length, m.
    pub lpp_m: f64,
    /// Breadth, m.
    pub beam_m: f64,
    /// Draught, m.
    pub draught_m: f64,
    /// Block coefficient.
    pub block_coefficient: f64,
    /// Transverse metacentric height, m.
    pub gm_m: f64,
    /// Natural period of roll, s.
    pub roll_period_s: f64,
    /// Damping of roll by the critical one.
    pub roll_damping: f64,
    /// The part of it that makes waves, from which the moment of waves follows.
    pub roll_radiation: f64,
}

/// A hull about as large as R/V Gunnerus.
#[cfg(test)]
pub(super) const GUNNERUS: WaveHull = WaveHull {
    lpp_m: 33.9,
    beam_m: 9.6,
    draught_m: 2.7,
    block_coefficient: 0.6,
    gm_m: 1.5,
    roll_period_s: 5.0,
    roll_damping: 0.1,
    roll_radiation: 0.02,
};
