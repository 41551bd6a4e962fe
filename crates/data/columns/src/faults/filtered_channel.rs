//! Channel that is searched for faults, with what other channels say of it.

/// A channel in SI units; a gap is NaN.
#[derive(Debug, Clone, Copy, Default)]
pub struct FilteredChannel<'a> {
    /// One value for each sample.
    pub values: &'a [f64],
    /// Rate of the channel by other channels, where there is one.
    pub rate: Option<&'a [f64]>,
    /// Integral of the channel by other channels, where there is one; without jumps of whole turns.
    pub integral: Option<&'a [f64]>,
    /// True if the channel is a direction, which wraps at a full turn.
    pub is_direction: bool,
    /// True if the channel is a position, which changes by velocities only.
    pub is_position: bool,
    /// Smallest distance from the prediction that is a fault, whatever the noise.
    pub least: f64,
    /// Magnitude above which a value is no reading of an instrument.
    pub impossible: f64,
}
