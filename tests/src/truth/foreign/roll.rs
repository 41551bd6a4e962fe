//! Roll of a wall-sided hull: righting lever `(GM + BM tan(phi)^2 / 2) sin(phi)`, damping with a
//! part that grows with the speed.

use crate::truth::dimensions::GRAVITY;

/// Roll stability and damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roll {
    /// Metacentric height, m.
    pub gm_m: f64,
    /// Metacentre above the centre of buoyancy, m.
    pub bm_m: f64,
    /// Radius of gyration with the water's share, m.
    pub gyradius_m: f64,
    /// Linear damping at rest, a share of the critical.
    pub damping: f64,
    /// What the speed of the approach adds to it.
    pub by_speed: f64,
    /// Quadratic damping by the moment of inertia, 1/rad.
    pub quadratic: f64,
    /// Levers of the sway forces of hull and devices about the centre of gravity, m.
    pub levers_m: [f64; 2],
}

/// What rolls a craft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heeling {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Sway forces of hull and devices, N.
    pub sway_n: [f64; 2],
    /// Speed by that of the approach.
    pub speed: f64,
}

impl Roll {
    /// Roll acceleration, rad/s2, at an angle (rad) and rate (rad/s).
    pub fn acceleration(&self, heeling: &Heeling, phi: f64, p: f64) -> f64 {
        let inertia = heeling.mass_kg * self.gyradius_m.powi(2);
        let lever = self.gm_m + 0.5 * self.bm_m * phi.tan().powi(2);
        let natural = (GRAVITY * self.gm_m).sqrt() / self.gyradius_m;
        let linear = 2.0 * natural * (self.damping + self.by_speed * heeling.speed);
        let [hull, devices] = self.levers_m;
        let moment = hull * heeling.sway_n[0] + devices * heeling.sway_n[1];
        let righting = GRAVITY * lever * phi.sin() / self.gyradius_m.powi(2);
        -moment / inertia - (linear + self.quadratic * p.abs()) * p - righting
    }
}
