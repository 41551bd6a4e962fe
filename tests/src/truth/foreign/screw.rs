//! A propeller in four quadrants: the blades as one element at 0.7 of the radius.
//!
//! With the inflow angle `beta = atan2(V_A, 0.7 pi n D)` and the angle of attack `alpha = phi -
//! beta` of a section of pitch angle `phi`, lift is `c_L sin(alpha) cos(alpha)` and drag `c_D0 +
//! c_D sin(alpha)^2`, of period pi as of a flat plate: Carlton (2018), Marine Propellers and
//! Propulsion, chapters 6 and 8, has the theory and the curves of the Wageningen series. The
//! coefficients are chosen so that a pitch ratio of 1 with a blade area ratio of 0.55 has `K_T` of
//! 0.44 and `K_Q` of 0.065 at bollard pull and an efficiency of 0.6 at `J = 0.7`.

use std::f64::consts::PI;

/// Lift of a section.
const LIFT: f64 = 1.12;
/// Drag of a section at no angle of attack, and its growth.
const DRAG: [f64; 2] = [0.012, 0.85];
/// Share of force that sections keep with their trailing edge ahead, from series of propellers
/// that run astern.
const ASTERN: f64 = 0.8;
/// Tip speed at which that is reached, m/s.
const ASTERN_M_S: f64 = 0.5;

/// A propeller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screw {
    /// Density of the water, kg/m3.
    pub density_kg_m3: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Pitch by diameter.
    pub pitch_ratio: f64,
    /// Expanded blade area by disc area.
    pub area_ratio: f64,
}

/// Thrust and torque of a shaft.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Turned {
    /// Thrust, N.
    pub thrust_n: f64,
    /// Torque that the shaft takes, N m.
    pub torque_n_m: f64,
}

impl Screw {
    /// Thrust and torque at a speed of advance and revolutions of any sign.
    pub fn turned(&self, advance_m_s: f64, n_rps: f64) -> Turned {
        let around = 0.7 * PI * n_rps * self.diameter_m;
        let square = advance_m_s.powi(2) + around.powi(2);
        let beta = advance_m_s.atan2(around);
        let attack = (self.pitch_ratio / (0.7 * PI)).atan() - beta;
        let backward = 0.5 * (1.0 - (n_rps * self.diameter_m / ASTERN_M_S).tanh());
        let quality = 1.0 - (1.0 - ASTERN) * backward;
        let head = 0.5 * self.density_kg_m3 * square * self.area_ratio * self.disc_m2() * quality;
        let lift = head * LIFT * attack.sin() * attack.cos();
        let drag = head * (DRAG[0] + DRAG[1] * attack.sin().powi(2));
        let (sin, cos) = beta.sin_cos();
        Turned {
            thrust_n: lift * cos - drag * sin,
            torque_n_m: 0.35 * self.diameter_m * (lift * sin + drag * cos),
        }
    }

    /// Signed speed far behind the disc, m/s, by momentum theory.
    pub fn slipstream_m_s(&self, advance_m_s: f64, thrust_n: f64) -> f64 {
        let added = 2.0 * thrust_n / (self.density_kg_m3 * self.disc_m2());
        signed_root(advance_m_s * advance_m_s.abs() + added)
    }

    /// Disc area, m2.
    pub fn disc_m2(&self) -> f64 {
        0.25 * PI * self.diameter_m.powi(2)
    }
}

/// The root of a size with its sign.
pub fn signed_root(value: f64) -> f64 {
    value.signum() * value.abs().sqrt()
}
