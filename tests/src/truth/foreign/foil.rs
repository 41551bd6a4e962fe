//! A foil in flow from any direction, which stalls.
//!
//! Attached flow has the slope of Whicker and Fehlner (1958), DTMB report 933, for a straight
//! quarter chord; separated flow the normal force of a plate after Hoerner and Borst (1975),
//! Fluid-Dynamic Lift. The flow passes from one to the other over some degrees.

use std::f64::consts::PI;

/// Drag at no angle of attack, of profiles of common thickness.
const PROFILE_DRAG: f64 = 0.012;
/// Normal force of a plate across the flow.
const PLATE: f64 = 1.8;
/// Range of angle over which the flow separates, rad.
const RANGE_RAD: f64 = 0.035;

/// A foil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foil {
    /// Density of the water, kg/m3.
    pub density_kg_m3: f64,
    /// Area, m2.
    pub area_m2: f64,
    /// Span over mean chord.
    pub aspect_ratio: f64,
    /// Angle at which the flow separates, rad: 0.3 to 0.6 for rudders in a slipstream.
    pub stall_rad: f64,
}

impl Foil {
    /// Forces (N) along and across the chord plane on a foil that moves at a velocity (m/s) along
    /// and across it.
    pub fn forces(&self, along: f64, across: f64) -> [f64; 2] {
        let square = along.powi(2) + across.powi(2);
        let angle = across.atan2(along);
        let (lift, drag) = self.coefficients(angle);
        let head = 0.5 * self.density_kg_m3 * self.area_m2 * square;
        let (sin, cos) = angle.sin_cos();
        [head * (lift * sin - drag * cos), -head * (lift * cos + drag * sin)]
    }

    /// Lift and drag coefficients at an angle of attack.
    fn coefficients(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let a = self.aspect_ratio;
        let slope = 1.8 * PI * a / (1.8 + (a * a + 4.0).sqrt());
        let attached = slope * sin * cos;
        let normal = PLATE * sin / (0.56 + 0.44 * sin.abs());
        let beyond = (sin.abs().asin() - self.stall_rad) / RANGE_RAD;
        let share = 1.0 / (1.0 + beyond.exp());
        let drag_attached = attached.powi(2) / (0.9 * PI * a);
        let lift = share * attached + (1.0 - share) * normal * cos;
        let drag = share * drag_attached + (1.0 - share) * normal * sin;
        (lift, drag + PROFILE_DRAG)
    }
}
