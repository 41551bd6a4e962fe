//! What instruments make of a track.

use std::collections::BTreeMap;

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};

use super::motion::Truth;

/// Standard deviations of the noise, and the sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruments {
    /// Between samples, s.
    pub interval_s: f64,
    /// Position, m.
    pub position_m: f64,
    /// Velocities, m/s.
    pub velocity_m_s: f64,
    /// Yaw and roll rate, rad/s.
    pub rate_rad_s: f64,
    /// Heading and roll, rad.
    pub angle_rad: f64,
    /// Rudder angle, rad.
    pub rudder_rad: f64,
    /// Revolutions by themselves.
    pub revolutions: f64,
}

impl Instruments {
    /// Of a sea trial: differential GNSS, a gyro compass, a rate gyro, the rudder's feedback; two
    /// samples a second.
    pub const SEA_TRIAL: Self = Self {
        interval_s: 0.5,
        position_m: 0.5,
        velocity_m_s: 0.03,
        rate_rad_s: 3e-4,
        angle_rad: 1.5e-3,
        rudder_rad: 2e-3,
        revolutions: 1e-3,
    };

    /// Of a free-running model of some metres: optical or RTK positions, a fibre-optic gyro; ten
    /// samples a second.
    pub const MODEL: Self = Self {
        interval_s: 0.1,
        position_m: 0.02,
        velocity_m_s: 0.012,
        rate_rad_s: 4e-3,
        angle_rad: 3e-3,
        rudder_rad: 4e-3,
        revolutions: 3e-3,
    };

    /// Perfect ones at the rate of a sea trial.
    pub const PERFECT: Self = Self {
        interval_s: 0.5,
        position_m: 0.0,
        velocity_m_s: 0.0,
        rate_rad_s: 0.0,
        angle_rad: 0.0,
        rudder_rad: 0.0,
        revolutions: 0.0,
    };

    /// Perfect ones at the rate of these.
    pub fn without_noise(&self) -> Self {
        Self { interval_s: self.interval_s, ..Self::PERFECT }
    }

    /// The instruments that a ship of this size has: those of a model below ten metres.
    pub fn of(ship: &dyn Truth) -> Self {
        if ship.dimensions().lpp_m < 10.0 { Self::MODEL } else { Self::SEA_TRIAL }
    }

    /// A trial as they record it; roll is recorded where the ship has it.
    pub fn record(
        &self,
        ship: &dyn Truth,
        name: &str,
        track: &Trajectory,
        rng: &mut ChaCha12Rng,
    ) -> Trial {
        let kept = (self.interval_s / ship.step_s()).round() as usize;
        let rolls = ship.dimensions().upright.is_some();
        let recorded = &RECORDED_CHANNELS[..if rolls { 8 } else { 6 }];
        let mut channels = BTreeMap::new();
        for &(channel, place) in recorded.iter().chain(&[(Channel::Delta, at::DELTA)]) {
            let true_values = track.states.iter().step_by(kept).map(|state| state[place]);
            channels.insert(channel, noisy(true_values, self.deviation(channel), rng));
        }
        let n_rps = track.n_rps.iter().step_by(kept).copied();
        let scatter = self.revolutions * ship.revolutions_rps();
        channels.insert(Channel::N, noisy(n_rps, scatter, rng));
        let t_s = track.t_s.iter().step_by(kept).copied().collect();
        Trial { name: name.to_owned(), t_s, channels, ..Trial::default() }
    }

    fn deviation(&self, channel: Channel) -> f64 {
        match channel {
            Channel::U | Channel::V => self.velocity_m_s,
            Channel::R | Channel::P => self.rate_rad_s,
            Channel::X | Channel::Y => self.position_m,
            Channel::Delta => self.rudder_rad,
            _ => self.angle_rad,
        }
    }
}

fn noisy(values: impl Iterator<Item = f64>, deviation: f64, rng: &mut ChaCha12Rng) -> Vec<f64> {
    values.map(|value| value + deviation * rng.sample::<f64, _>(StandardNormal)).collect()
}
