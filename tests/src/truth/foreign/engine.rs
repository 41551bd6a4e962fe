//! What turns a shaft: a governor that holds the ordered revolutions as far as torque and power
//! allow.

/// Kinds of limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Of torque, as of a diesel engine: revolutions fall when the propeller gets heavier.
    Torque,
    /// Of power, as of an electric motor: torque rises as revolutions fall, up to 1.4 times.
    Power,
}

/// An engine and its governor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Engine {
    /// What is limited.
    pub limit: Limit,
    /// Limit by what the approach takes.
    pub margin: f64,
    /// Order on the approach by the revolutions that are reached: above 1, the limit holds them.
    pub order: f64,
    /// Time constant of the governor, s.
    pub lag_s: f64,
    /// Time in which the torque of the approach brings the shaft to its revolutions, s.
    pub run_up_s: f64,
}

/// Revolutions and torque of a shaft on the approach.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rating {
    /// Revolutions, 1/s.
    pub n_rps: f64,
    /// Torque, N m.
    pub torque_n_m: f64,
}

/// Torque by that of the rating, at most.
const OVERLOAD: f64 = 1.4;

impl Engine {
    /// Acceleration of a shaft, 1/s2, with an order and the torque that its propeller takes.
    pub fn acceleration(&self, rating: Rating, n_rps: f64, order_rps: f64, load_n_m: f64) -> f64 {
        let most = self.margin * self.torque_limit(rating, n_rps);
        let unit = rating.n_rps / (self.run_up_s * rating.torque_n_m);
        let governed = (order_rps - n_rps) / self.lag_s;
        governed.clamp((-most - load_n_m) * unit, (most - load_n_m) * unit)
    }

    fn torque_limit(&self, rating: Rating, n_rps: f64) -> f64 {
        let rise = match self.limit {
            Limit::Torque => 1.0,
            Limit::Power => (rating.n_rps / n_rps.abs().max(1e-9)).min(OVERLOAD),
        };
        rise * rating.torque_n_m
    }
}
