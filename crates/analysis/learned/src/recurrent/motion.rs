//! Recorded motion for the training of networks.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::branch::CorrectionInstant;

/// Recorded motion, sample by sample.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMotion {
    /// Sampling interval, s.
    pub interval_s: f64,
    /// Positions and headings x, y, psi: m, m, rad.
    pub positions: Vec<[f64; 3]>,
    /// Velocities u, v, r: m/s, m/s, rad/s.
    pub velocities: Vec<[f64; 3]>,
    /// Further inputs at each sample: rudder, revolutions, and the apparent wind along and across
    /// the ship (Wakita 2022, Eq. 7).
    pub known: Vec<Vec<f64>>,
    /// Accelerations of a foundation along the recorded motion, m/s2, m/s2, rad/s2; zeros without
    /// foundation.
    pub given: Vec<[f64; 3]>,
}

impl RecordedMotion {
    /// Returns the parts of a trial between gaps, `None` if it lacks a channel or holds a value
    /// that is not finite. `foundation` holds the instants of a foundation along the trial.
    pub fn from_trial(
        trial: &Trial,
        foundation: Option<&[CorrectionInstant]>,
    ) -> Option<Vec<Self>> {
        let channel = |channel: Channel| trial.channel(channel);
        let three = |channels: [Channel; 3]| -> Option<[&[f64]; 3]> {
            let [a, b, c] = channels.map(channel);
            Some([a?, b?, c?])
        };
        let positions = three([Channel::X, Channel::Y, Channel::Psi])?;
        let velocities = three([Channel::U, Channel::V, Channel::R])?;
        let (delta, n) = (channel(Channel::Delta)?, channel(Channel::N)?);
        let wind = (channel(Channel::ApparentWindSpeed), channel(Channel::ApparentWindFrom));
        let known = |k: usize| {
            let mut known = vec![delta[k], n[k]];
            if let (Some(speed), Some(from)) = wind {
                // Components of the wind, as its direction has a jump at 360 degrees.
                let (sin, cos) = from[k].sin_cos();
                known.extend([speed[k] * cos, speed[k] * sin]);
            }
            known
        };
        let given = |k: usize| foundation.map_or([0.0; 3], |instants| instants[k].accelerations);
        let part = |own: std::ops::Range<usize>| Self {
            interval_s: trial.interval_s(),
            positions: own.clone().map(|k| positions.map(|column| column[k])).collect(),
            velocities: own.clone().map(|k| velocities.map(|column| column[k])).collect(),
            known: own.clone().map(known).collect(),
            given: own.map(given).collect(),
        };
        let parts: Vec<Self> = trial.segments().into_iter().map(part).collect();
        // One value that is not finite makes the whole trial unusable.
        parts.iter().all(Self::is_finite).then_some(parts)
    }

    /// True if all values are finite.
    fn is_finite(&self) -> bool {
        let states = self.positions.iter().chain(&self.velocities).chain(&self.given).flatten();
        states.chain(self.known.iter().flatten()).all(|number| number.is_finite())
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.velocities.len()
    }

    /// True if there is no sample.
    pub fn is_empty(&self) -> bool {
        self.velocities.is_empty()
    }

    /// Accelerations by differences from one sample to the next, less those of the foundation:
    /// m/s2, m/s2, rad/s2.
    pub fn unexplained_acceleration(&self, k: usize) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let change = self.velocities[k + 1][axis] - self.velocities[k][axis];
            change / self.interval_s - self.given[k][axis]
        })
    }
}
