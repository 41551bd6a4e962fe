//! A fixed thruster without a rudder.

use super::{Device, Flow, Load};
use crate::truth::foreign::screw::Screw;

/// The thruster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thruster {
    /// Propeller.
    pub screw: Screw,
    /// Wake fraction.
    pub wake: f64,
    /// Thrust deduction fraction.
    pub deduction: f64,
    /// Share of the momentum across that is taken out of the water.
    pub turned_in: f64,
}

impl Device for Thruster {
    fn load(&self, flow: Flow, _: f64, n_rps: f64) -> Load {
        let advance = (1.0 - self.wake) * flow.along;
        let turned = self.screw.turned(advance, n_rps);
        let slipstream = self.screw.slipstream_m_s(advance, turned.thrust_n);
        let through =
            self.screw.density_kg_m3 * self.screw.disc_m2() * 0.5 * (advance + slipstream);
        Load {
            surge_n: (1.0 - self.deduction) * turned.thrust_n,
            sway_n: -self.turned_in * through.abs() * flow.across,
            on_hull_n: 0.0,
            torque_n_m: turned.torque_n_m,
        }
    }
}
