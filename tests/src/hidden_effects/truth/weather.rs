//! The wind that blows.

use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

/// A true wind with slow gusts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weather {
    /// Mean speed, m/s.
    pub speed_m_s: f64,
    /// Where it comes from, rad clockwise from north.
    pub from_rad: f64,
}

/// Standard deviation of the speed by its mean, and its correlation time, s.
const GUSTS: (f64, f64) = (0.05, 20.0);

impl Weather {
    /// The speed at the start of each step: an Ornstein-Uhlenbeck process about the mean.
    pub fn speeds(self, steps: usize, step_s: f64, rng: &mut ChaCha12Rng) -> Vec<f64> {
        let decay = (-step_s / GUSTS.1).exp();
        let kick = (1.0 - decay * decay).sqrt();
        let mut gust: f64 = StandardNormal.sample(rng);
        let mut next = || {
            let speed = self.speed_m_s * (1.0 + GUSTS.0 * gust);
            let normal: f64 = StandardNormal.sample(rng);
            gust = decay * gust + kick * normal;
            speed
        };
        (0..steps).map(|_| next()).collect()
    }
}
