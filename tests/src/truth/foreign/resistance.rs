//! Resistance of displacement and of planing hulls, and of the air.

use super::size::Size;
use crate::truth::dimensions::GRAVITY;

/// Kinematic viscosity of water at 15 degrees, m2/s.
const VISCOSITY_M2_S: f64 = 1.14e-6;
/// Least Reynolds number of the friction line.
const LEAST_REYNOLDS: f64 = 1e5;
/// Resistance astern by that ahead, chosen for sterns that are not formed for it.
const ASTERN: f64 = 1.25;

/// Resistance in straight running.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resistance {
    /// `C_T = (1 + k) C_F + C_A + c_W exp(-(F_h / F_n)^2)`, with the ITTC 1957 line.
    Displacement {
        /// Wetted surface, m2.
        wetted_m2: f64,
        /// Form factor `1 + k`.
        form: f64,
        /// Roughness allowance.
        allowance: f64,
        /// Wave resistance coefficient at high speed, and the Froude number at which it rises.
        wave: [f64; 2],
    },
    /// Weight times the trim of the hump, `tan(tau) = tau_max s exp(1 - s)`, and friction of a
    /// wetted surface that shrinks by `s / (1 + s)`, with `s` the squared speed by that of the
    /// hump: form of the curves in Savitsky (1964), Marine Technology 1, 71-95.
    Planing {
        /// Wetted surface at rest, m2.
        wetted_m2: f64,
        /// Weight, N.
        weight_n: f64,
        /// Greatest trim, rad.
        trim_rad: f64,
        /// Speed of the hump, m/s.
        hump_m_s: f64,
        /// Share of the wetted surface, and of the immersion, that is lifted out at high speed.
        lifted: f64,
    },
}

impl Resistance {
    /// Surge force, N, at a speed ahead (m/s) of a length (m).
    pub fn force_n(&self, density: f64, length_m: f64, u: f64) -> f64 {
        let friction = friction(length_m, u);
        let size = match *self {
            Self::Displacement { wetted_m2, form, allowance, wave: [wave, rise] } => {
                let froude = u.abs() / (GRAVITY * length_m).sqrt();
                let waves = wave * (-(rise / froude.max(1e-6)).powi(2)).exp();
                0.5 * density * wetted_m2 * (form * friction + allowance + waves) * u * u
            }
            Self::Planing { wetted_m2, weight_n, trim_rad, hump_m_s, .. } => {
                let s = (u / hump_m_s).powi(2);
                let wetted = wetted_m2 * self.immersion(u);
                weight_n * trim_rad * s * (1.0 - s).exp()
                    + 0.5 * density * wetted * (1.1 * friction + 0.0008) * u * u
            }
        };
        if u < 0.0 { ASTERN * size } else { -size }
    }

    /// Immersion of the hull by that at rest.
    pub fn immersion(&self, u: f64) -> f64 {
        match *self {
            Self::Displacement { .. } => 1.0,
            Self::Planing { hump_m_s, lifted, .. } => {
                let s = (u / hump_m_s).powi(2);
                1.0 - lifted * s / (1.0 + s)
            }
        }
    }
}

/// ITTC 1957: `0.075 / (log10 Re - 2)^2`.
fn friction(length_m: f64, u: f64) -> f64 {
    let reynolds = (u.abs() * length_m / VISCOSITY_M2_S).max(LEAST_REYNOLDS);
    0.075 / (reynolds.log10() - 2.0).powi(2)
}

/// Area above the water in still air: drag along and across the apparent wind of the craft's own
/// motion, with the coefficients of Blendermann (1994) for car carriers at head and beam wind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Windage {
    /// Frontal area, m2.
    pub frontal_m2: f64,
    /// Lateral area, m2.
    pub lateral_m2: f64,
    /// Centre of the lateral area ahead of midship, m.
    pub centre_m: f64,
}

impl Windage {
    /// Surge, sway (N) and yaw (N m).
    pub fn forces(&self, [u, v, r]: [f64; 3]) -> [f64; 3] {
        let across = v + self.centre_m * r;
        let speed = u.hypot(across);
        let x = -0.5 * AIR_KG_M3 * 0.55 * self.frontal_m2 * speed * u;
        let y = -0.5 * AIR_KG_M3 * 0.95 * self.lateral_m2 * speed * across;
        [x, y, self.centre_m * y]
    }
}

/// Density of air, kg/m3.
const AIR_KG_M3: f64 = 1.225;

/// Resistance of a displacement hull of a size.
pub fn displacement(size: &Size, form: f64, allowance: f64, wave: [f64; 2]) -> Resistance {
    Resistance::Displacement { wetted_m2: size.wetted_surface_m2(), form, allowance, wave }
}
