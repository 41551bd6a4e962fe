//! An outboard motor: the whole propeller turns, its lower unit is a small foil, its blades push
//! the stern aside, and it draws air at large angles.

use super::{Axes, Device, Flow, Load};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::screw::Screw;

/// The motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outboard {
    /// Propeller.
    pub screw: Screw,
    /// Wake fraction.
    pub wake: f64,
    /// Side force of the blades by that of the torque, to starboard ahead.
    pub walk: f64,
    /// Share of the thrust that is lost to air at a right angle.
    pub ventilated: f64,
    /// Lower unit.
    pub foil: Foil,
}

impl Device for Outboard {
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load {
        let axes = Axes::new(angle_rad);
        let [along, across] = axes.resolve((1.0 - self.wake) * flow.along, flow.across);
        let turned = self.screw.turned(along, n_rps);
        let slipstream = self.screw.slipstream_m_s(along, turned.thrust_n);
        let kept = 1.0 - self.ventilated * angle_rad.sin().powi(2);
        let [drag, side] = self.foil.forces(0.5 * (along + slipstream), across);
        let walk = self.walk * turned.torque_n_m / (0.35 * self.screw.diameter_m);
        let [surge_n, sway_n] = axes.to_craft([kept * turned.thrust_n + drag, side + walk]);
        Load { surge_n, sway_n, on_hull_n: 0.0, torque_n_m: kept * turned.torque_n_m }
    }
}
