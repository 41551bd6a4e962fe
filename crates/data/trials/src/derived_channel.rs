//! Data on a channel that was derived rather than measured.

use sistership_model::trial::Channel;

/// Derived channel with its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedChannel {
    /// Channel that was derived.
    pub channel: Channel,
    /// Variance of each sample, the square of the channel's unit.
    pub variance: Vec<f64>,
    /// Density of the white noise on the third derivative of the recorded quantity, its unit
    /// squared per s^5.
    pub process_noise: f64,
    /// Standard deviation of a reading of the recorded quantity, m or rad.
    pub reading_sd: f64,
}
