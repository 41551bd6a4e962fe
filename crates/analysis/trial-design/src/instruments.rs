//! Instruments by which planned trials are recorded.

use serde::{Deserialize, Serialize};
use sistership_filtering::{InstrumentNoise, NoiseLevel};
use sistership_model::trial::Channel;

/// Standard deviations of the noise of readings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InstrumentAccuracy {
    /// Position, m.
    pub position_m: f64,
    /// Velocities, m/s.
    pub velocity_m_s: f64,
    /// Yaw and roll rate, rad/s.
    pub rate_rad_s: f64,
    /// Heading and roll, rad.
    pub angle_rad: f64,
}

impl InstrumentAccuracy {
    /// Instruments of a sea trial. Source: chosen; differential GNSS, gyro compass and rate gyro.
    pub const SEA_TRIAL: Self =
        Self { position_m: 0.5, velocity_m_s: 0.03, rate_rad_s: 3e-4, angle_rad: 1.5e-3 };

    /// Instruments of a free-running model. Source: chosen; optical or RTK positions and a
    /// fibre-optic gyro.
    pub const MODEL: Self =
        Self { position_m: 0.02, velocity_m_s: 0.012, rate_rad_s: 4e-3, angle_rad: 3e-3 };

    /// Default instruments of a ship of this length, m: below ten metres it is a model.
    pub fn for_length(lpp_m: f64) -> Self {
        if lpp_m < 10.0 { Self::MODEL } else { Self::SEA_TRIAL }
    }

    /// Noise by channel, of which only the standard deviation is known.
    pub(crate) fn channel_noise(&self) -> InstrumentNoise {
        let all = [
            (Channel::X, self.position_m),
            (Channel::Y, self.position_m),
            (Channel::U, self.velocity_m_s),
            (Channel::V, self.velocity_m_s),
            (Channel::R, self.rate_rad_s),
            (Channel::P, self.rate_rad_s),
            (Channel::Psi, self.angle_rad),
            (Channel::Phi, self.angle_rad),
        ];
        all.into_iter().map(|(channel, d)| (channel, NoiseLevel::from_deviation(d))).collect()
    }
}
