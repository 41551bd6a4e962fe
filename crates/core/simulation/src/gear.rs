//! Steering gear: from the ordered rudder angle to the actual one.

use sistership_model::vessel::Steering;

/// Steering gear with a limit, a rate limit and a time constant, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteeringGear {
    limit_rad: f64,
    rate_rad_s: f64,
    time_constant_s: f64,
    band_rad: f64,
}

impl SteeringGear {
    /// Creates the steering gear that a model describes.
    pub fn new(steering: &Steering) -> Self {
        Self {
            limit_rad: steering.limit_deg.to_radians(),
            rate_rad_s: steering.rate_deg_s.to_radians(),
            time_constant_s: steering.time_constant_s,
            band_rad: 0.0,
        }
    }

    /// Returns the gear with an additional lag, s.
    pub fn with_lag(self, lag_s: f64) -> Self {
        Self { time_constant_s: self.time_constant_s + lag_s, ..self }
    }

    /// Returns the gear with a dead band: it moves only where the order leaves a band of `band_rad`
    /// to either side of the angle.
    pub fn with_band(self, band_rad: f64) -> Self {
        Self { band_rad, ..self }
    }

    /// Largest rudder angle, rad.
    pub fn limit_rad(&self) -> f64 {
        self.limit_rad
    }

    /// Largest rudder rate, rad/s.
    pub fn rate_rad_s(&self) -> f64 {
        self.rate_rad_s
    }

    /// Time constant, s.
    pub fn time_constant_s(&self) -> f64 {
        self.time_constant_s
    }

    /// Returns the rudder rate, rad/s. A gear without a time constant would chatter about its
    /// order: an order within reach of one step of `step_s` is therefore met exactly at its end.
    pub fn rudder_rate(&self, order_rad: f64, angle_rad: f64, step_s: f64) -> f64 {
        let order = order_rad.clamp(-self.limit_rad, self.limit_rad);
        // Not `clamp`, which panics on an order that is NaN.
        let order = match self.band_rad > 0.0 {
            true => angle_rad.max(order - self.band_rad).min(order + self.band_rad),
            false => order,
        };
        // First-order lag: the rate is the remaining angle over the time constant, limited.
        let time = self.time_constant_s.max(step_s);
        ((order - angle_rad) / time).clamp(-self.rate_rad_s, self.rate_rad_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_within_the_play_is_not_followed() {
        let steering = Steering { limit_deg: 35.0, rate_deg_s: 2.0, ..Steering::default() };
        let gear = SteeringGear::new(&steering).with_band(0.02);
        assert_eq!(gear.rudder_rate(0.1, 0.09, 1.0), 0.0);
        assert!((gear.rudder_rate(0.1, 0.05, 1.0) - 0.03).abs() < 1e-12, "to the edge of the play");
        assert!((gear.rudder_rate(-0.1, -0.05, 1.0) + 0.03).abs() < 1e-12);
    }
}
