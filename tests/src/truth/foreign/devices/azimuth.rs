//! A ducted azimuth thruster: propeller and nozzle, the momentum of the water that the duct takes
//! in across its axis, and its leg as a foil in the slipstream.

use super::{Axes, Device, Flow, Load};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::screw::Screw;

/// The thruster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Azimuth {
    /// Propeller.
    pub screw: Screw,
    /// Wake fraction.
    pub wake: f64,
    /// Thrust of the nozzle by that of the propeller at bollard pull, as of nozzle 19A.
    pub nozzle: f64,
    /// Advance ratio at which the nozzle is only a drag.
    pub nozzle_idle: f64,
    /// Share of the momentum across that is taken out of the water.
    pub turned_in: f64,
    /// Thrust deduction fraction with the thruster ahead, and what is added as it blows against
    /// the skeg and the other thruster.
    pub deduction: [f64; 2],
    /// Leg.
    pub foil: Foil,
}

impl Azimuth {
    /// Thrust of propeller and nozzle.
    fn thrust_n(&self, along: f64, n_rps: f64, propeller_n: f64) -> f64 {
        let around = (n_rps * self.screw.diameter_m).abs().max(1e-3);
        let idle = 1.0 - (along / (self.nozzle_idle * around)).clamp(-1.0, 2.0);
        propeller_n + self.nozzle * idle * propeller_n.max(0.0)
    }
}

impl Device for Azimuth {
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load {
        let axes = Axes::new(angle_rad);
        let [along, across] = axes.resolve((1.0 - self.wake) * flow.along, flow.across);
        let turned = self.screw.turned(along, n_rps);
        let thrust = self.thrust_n(along, n_rps, turned.thrust_n);
        let slipstream = self.screw.slipstream_m_s(along, thrust);
        let through = self.screw.density_kg_m3 * self.screw.disc_m2() * 0.5 * (along + slipstream);
        let taken_in = -self.turned_in * through.abs() * across;
        let [drag, side] = self.foil.forces(0.5 * (along + slipstream), across);
        let [ahead, blown] = self.deduction;
        let kept = 1.0 - ahead - blown * angle_rad.sin().powi(2);
        let [surge_n, sway_n] = axes.to_craft([kept * thrust + drag, taken_in + side]);
        Load { surge_n, sway_n, on_hull_n: 0.0, torque_n_m: turned.torque_n_m }
    }
}
