//! A podded propeller that pulls: blades in oblique flow have a force in their plane, and the strut
//! behind them is a foil in the slipstream.

use super::{Axes, Device, Flow, Load};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::screw::Screw;

/// The pod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pod {
    /// Propeller.
    pub screw: Screw,
    /// Wake fraction.
    pub wake: f64,
    /// Thrust deduction fraction.
    pub deduction: f64,
    /// In-plane force by `rho n D^3` and the velocity across.
    pub in_plane: f64,
    /// Share of the drift that reaches the pod.
    pub straightening: f64,
    /// Strut.
    pub foil: Foil,
    /// Drag area of the body, m2.
    pub body_m2: f64,
}

impl Device for Pod {
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load {
        let axes = Axes::new(angle_rad);
        let seen = self.straightening * flow.across;
        let [along, across] = axes.resolve((1.0 - self.wake) * flow.along, seen);
        let turned = self.screw.turned(along, n_rps);
        let slipstream = self.screw.slipstream_m_s(along, turned.thrust_n);
        let density = self.screw.density_kg_m3;
        let around = density * n_rps.abs() * self.screw.diameter_m.powi(3);
        let in_plane = -self.in_plane * around * across;
        let [strut, side] = self.foil.forces(0.3 * along + 0.7 * slipstream, across);
        let body = -0.5 * density * self.body_m2 * along * along.abs();
        let thrust = (1.0 - self.deduction) * turned.thrust_n;
        let [surge_n, sway_n] = axes.to_craft([thrust + strut + body, in_plane + side]);
        Load { surge_n, sway_n, on_hull_n: 0.0, torque_n_m: turned.torque_n_m }
    }
}
