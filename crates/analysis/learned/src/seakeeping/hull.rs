//! Particulars of a ship for closed-form responses.

use serde::{Deserialize, Serialize};

/// Particulars of a ship at zero speed in waves, SI units.
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
    /// Roll damping, as a fraction of the critical one.
    pub roll_damping: f64,
    /// Part of the roll damping due to wave radiation, from which the wave moment follows.
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
