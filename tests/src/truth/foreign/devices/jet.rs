//! A water jet: a pump that adds head to what its inlet takes in, a nozzle that turns, a bucket
//! that throws the jet forward.
//!
//! The jet leaves at `V_j`, `V_j^2 = (1 - zeta) V_in^2 + k (n D)^2`; its momentum `rho A V_j^2`
//! acts at the nozzle, that of the water taken in, `rho A V_j` times the velocity of the inlet, at
//! the inlet: Allison (1993), Marine waterjet propulsion, SNAME Transactions 101. Revolutions
//! below zero stand for a pump with the bucket down.

use super::{Axes, Device, Flow, Load};

/// Revolutions by those of the pump's order over which the bucket moves, 1/s.
const BUCKET_RPS: f64 = 0.5;

/// The jet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// Density of the water, kg/m3.
    pub density_kg_m3: f64,
    /// Nozzle area, m2.
    pub nozzle_m2: f64,
    /// Impeller diameter, m.
    pub impeller_m: f64,
    /// Head by the squared speed `n D`.
    pub head: f64,
    /// Loss of the inlet.
    pub inlet_loss: f64,
    /// Torque by `rho n^2 D^5`.
    pub torque: f64,
    /// Share of the jet that the bucket throws forward.
    pub bucket: f64,
    /// Share of the drift at the inlet that is not straightened by the hull.
    pub straightening: f64,
}

impl Device for Jet {
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load {
        let around = n_rps * self.impeller_m;
        let taken_in = flow.along.max(0.0);
        let square = (1.0 - self.inlet_loss) * taken_in.powi(2) + self.head * around.powi(2);
        let jet = square.sqrt();
        let mass = self.density_kg_m3 * self.nozzle_m2 * jet;
        let ahead = 0.5 * (1.0 + (n_rps / BUCKET_RPS).tanh());
        let thrown = ahead - self.bucket * (1.0 - ahead);
        let axes = Axes::new(angle_rad);
        let [surge, sway] = axes.to_craft([mass * jet * thrown, 0.0]);
        let square_n = self.density_kg_m3 * n_rps * n_rps.abs() * self.impeller_m.powi(5);
        Load {
            surge_n: surge - mass * flow.along,
            sway_n: sway - mass * self.straightening * flow.across,
            on_hull_n: 0.0,
            torque_n_m: self.torque * square_n,
        }
    }
}
