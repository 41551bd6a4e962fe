//! What is kept of a channel that was not measured.

use sistership_model::trial::Channel;

/// A channel that was not measured, and how well it is known.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedChannel {
    /// Which.
    pub channel: Channel,
    /// Variance of each sample, the square of the channel's unit.
    pub variance: Vec<f64>,
    /// Density of the white noise that disturbs the second derivative of what was recorded, its
    /// unit squared by s^5.
    pub process_noise: f64,
    /// Standard deviation of a reading of what was recorded, m or rad.
    pub reading_sd: f64,
}
