//! Resistance by the ITTC 1957 friction line, `C_F = 0.075 / (log10 Re - 2)^2`.

use super::dimensions::Dimensions;

/// Kinematic viscosity of water at 15 degrees, m2/s.
const VISCOSITY_M2_S: f64 = 1.14e-6;
/// The line is not used below this number, where the flow is laminar.
const LEAST_REYNOLDS: f64 = 1e4;

/// What adds to flat-plate friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resistance {
    /// Form factor `1 + k`.
    pub form: f64,
    /// Residuary and roughness allowance, by wetted surface.
    pub residuary: f64,
}

impl Resistance {
    /// Surge force, N, against the speed `u`.
    pub fn force_n(&self, ship: &Dimensions, u: f64) -> f64 {
        let reynolds = (u.abs() * ship.lpp_m / VISCOSITY_M2_S).max(LEAST_REYNOLDS);
        let friction = 0.075 / (reynolds.log10() - 2.0).powi(2);
        let coefficient = self.form * friction + self.residuary;
        -0.5 * ship.density_kg_m3 * ship.wetted_surface_m2() * coefficient * u * u.abs()
    }
}
