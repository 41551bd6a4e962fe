//! A rudder as a wing of small aspect ratio: Soeding (1982), as in Bertram (2012), Practical Ship
//! Hydrodynamics, chapter 6.

/// Coefficient of the resistance across the blade in Soeding's formula.
const ACROSS: f64 = 1.0;
/// Drag without lift, chosen as that of a profile of common thickness.
const PROFILE_DRAG: f64 = 0.012;

/// A rudder behind a propeller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rudder {
    /// Area, m2.
    pub area_m2: f64,
    /// Height over mean chord.
    pub aspect_ratio: f64,
    /// Place ahead of midship, m.
    pub x_m: f64,
    /// Share of the area in the slipstream.
    pub in_slipstream: f64,
    /// Share of the slipstream's acceleration that is reached at the rudder.
    pub accelerated: f64,
    /// Share of the drift at the rudder that the hull leaves.
    pub straightening: f64,
    /// Force that the rudder draws on the hull, by its own.
    pub hull_force: f64,
    /// Where that acts, m ahead of midship.
    pub hull_x_m: f64,
}

/// Forces on ship and rudder: surge, sway (N), yaw (N m).
pub type Forces = [f64; 3];

impl Rudder {
    /// Axial speed at the rudder, m/s: squares averaged over the area in and out of the slipstream.
    pub fn axial_m_s(&self, advance_m_s: f64, slipstream_m_s: f64) -> f64 {
        let inside = advance_m_s + self.accelerated * (slipstream_m_s - advance_m_s);
        let square = |speed: f64| speed * speed.abs();
        let mean =
            self.in_slipstream * square(inside) + (1.0 - self.in_slipstream) * square(advance_m_s);
        mean.max(0.0).sqrt()
    }

    /// Forces at an angle (rad, positive turns to starboard), an axial speed, and the sway velocity
    /// at the rudder.
    pub fn forces(&self, density: f64, delta: f64, axial_m_s: f64, across_m_s: f64) -> Forces {
        let across = self.straightening * across_m_s;
        let inflow = across.atan2(axial_m_s.max(1e-6));
        let head = 0.5 * density * self.area_m2 * (axial_m_s.powi(2) + across.powi(2));
        let (lift, drag) = self.coefficients(delta + inflow);
        let (sin, cos) = inflow.sin_cos();
        let surge = head * (lift * sin - drag * cos);
        let sway = -head * (lift * cos + drag * sin);
        let lever = self.x_m + self.hull_force * self.hull_x_m;
        [surge, (1.0 + self.hull_force) * sway, lever * sway]
    }

    /// `C_L = 2 pi A (A + 0.7) / (A + 1.7)^2 sin a + C_Q sin a |sin a| cos a`, `C_D = C_L^2 / (pi
    /// A) + C_Q |sin a|^3 + C_D0`.
    fn coefficients(&self, angle: f64) -> (f64, f64) {
        let (a, sin) = (self.aspect_ratio, angle.sin());
        let slope = std::f64::consts::TAU * a * (a + 0.7) / (a + 1.7).powi(2);
        let lift = slope * sin + ACROSS * sin * sin.abs() * angle.cos();
        let drag = lift.powi(2) / (std::f64::consts::PI * a) + ACROSS * sin.abs().powi(3);
        (lift, drag + PROFILE_DRAG)
    }
}
