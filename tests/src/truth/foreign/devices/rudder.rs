//! A propeller with a rudder in its slipstream.

use super::{Axes, Device, Flow, Load};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::screw::{Screw, signed_root};

/// Drift at which half of the wake is gone, rad.
const WAKE_DRIFT_RAD: f64 = 0.45;
/// Drift at which most of the straightening is gone, rad.
const STRAIGHTENED_RAD: f64 = 0.3;

/// Propeller and rudder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScrewAndRudder {
    /// Propeller.
    pub screw: Screw,
    /// Wake fraction in straight running ahead.
    pub wake: f64,
    /// Thrust deduction fraction.
    pub deduction: f64,
    /// Side force of the blades by that of the torque, to starboard ahead for a propeller that
    /// turns clockwise seen from aft; zero where two of them turn against each other.
    pub walk: f64,
    /// Rudder.
    pub foil: Foil,
    /// Share of its area in the slipstream.
    pub in_slipstream: f64,
    /// Share of the slipstream's acceleration that is reached there.
    pub accelerated: f64,
    /// Share of the drift that the rudder sees at small drift, and what is added at large.
    pub straightening: [f64; 2],
    /// Force drawn on the hull by that of the rudder.
    pub on_hull: f64,
}

impl ScrewAndRudder {
    fn advance(&self, flow: Flow) -> f64 {
        let drift = flow.across.atan2(flow.along.abs().max(1e-6));
        let ahead = 0.5 * (1.0 + (flow.along / 0.2).tanh());
        let wake = self.wake * ahead / (1.0 + (drift / WAKE_DRIFT_RAD).powi(2));
        (1.0 - wake) * flow.along
    }

    /// Velocity at the rudder along the craft, squares averaged over its area.
    fn axial(&self, advance: f64, thrust_n: f64) -> f64 {
        let slipstream = self.screw.slipstream_m_s(advance, thrust_n);
        let inside = advance + self.accelerated * (slipstream - advance);
        let square = |speed: f64| speed * speed.abs();
        let share = self.in_slipstream;
        signed_root(share * square(inside) + (1.0 - share) * square(advance))
    }

    fn across(&self, flow: Flow) -> f64 {
        let drift = flow.across.abs() / flow.along.abs().max(1e-6) / STRAIGHTENED_RAD;
        let [small, more] = self.straightening;
        (small + more * (1.0 - (-drift * drift).exp())) * flow.across
    }
}

impl Device for ScrewAndRudder {
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load {
        let advance = self.advance(flow);
        let turned = self.screw.turned(advance, n_rps);
        let axes = Axes::new(angle_rad);
        let [along, across] = axes.resolve(self.axial(advance, turned.thrust_n), self.across(flow));
        let [surge, sway] = axes.to_craft(self.foil.forces(along, across));
        let walk = self.walk * turned.torque_n_m / (0.35 * self.screw.diameter_m);
        Load {
            surge_n: (1.0 - self.deduction) * turned.thrust_n + surge,
            sway_n: sway,
            on_hull_n: self.on_hull * sway + walk,
            torque_n_m: turned.torque_n_m,
        }
    }
}
