//! Recorded motion as networks are trained on it.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::branch::Instant;

/// Recorded motion, sample by sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// From one sample to the next, s.
    pub interval_s: f64,
    /// x, y, psi: m, m, rad.
    pub positions: Vec<[f64; 3]>,
    /// u, v, r: m/s, m/s, rad/s.
    pub velocities: Vec<[f64; 3]>,
    /// What is known beside them at each sample: rudder, revolutions, and the apparent wind along
    /// and across the ship (Wakita 2022, Eq. 7).
    pub known: Vec<Vec<f64>>,
    /// What a foundation gives of the accelerations along the recorded motion, m/s2, m/s2, rad/s2;
    /// zeros where there is none.
    pub given: Vec<[f64; 3]>,
}

impl Motion {
    /// The parts of a trial without gaps; none where it lacks a channel or holds what is no number.
    /// `foundation` are a foundation's instants along it.
    pub fn parts(trial: &Trial, foundation: Option<&[Instant]>) -> Option<Vec<Self>> {
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
        parts.iter().all(Self::is_number).then_some(parts)
    }

    fn is_number(&self) -> bool {
        let states = self.positions.iter().chain(&self.velocities).chain(&self.given).flatten();
        states.chain(self.known.iter().flatten()).all(|number| number.is_finite())
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.velocities.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.velocities.is_empty()
    }

    /// The accelerations by differences from one sample to the next, less what the foundation
    /// gives: m/s2, m/s2, rad/s2.
    pub fn differences(&self, k: usize) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let change = self.velocities[k + 1][axis] - self.velocities[k][axis];
            change / self.interval_s - self.given[k][axis]
        })
    }
}
