//! Standard deviations by which a network's inputs, outputs and states are divided.

use serde::{Deserialize, Serialize};

use super::motion::RecordedMotion;
use crate::sample::centre_and_scale;

/// Standard deviations by which inputs, outputs and states are divided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionScales {
    /// Scales of x, y, psi.
    pub positions: [f64; 3],
    /// Scales of u, v, r.
    pub velocities: [f64; 3],
    /// Scales of the further inputs.
    pub known: Vec<f64>,
    /// Scales of the accelerations, by differences.
    pub accelerations: [f64; 3],
}

impl MotionScales {
    /// Computes the scales of some motions.
    pub fn from_motions(motions: &[RecordedMotion]) -> Self {
        let scale = |of: &dyn Fn(&RecordedMotion) -> Vec<f64>| {
            centre_and_scale(&motions.iter().flat_map(of).collect::<Vec<f64>>()).1
        };
        let three = |of: &dyn Fn(&RecordedMotion, usize, usize) -> f64, less: usize| {
            let axis = |axis: usize| {
                let column = |motion: &RecordedMotion| {
                    (0..motion.len() - less).map(|k| of(motion, k, axis)).collect()
                };
                scale(&column)
            };
            std::array::from_fn(axis)
        };
        let known = motions.first().map_or(0, |motion| motion.known[0].len());
        Self {
            positions: three(&|motion, k, axis| motion.positions[k][axis], 0),
            velocities: three(&|motion, k, axis| motion.velocities[k][axis], 0),
            known: (0..known)
                .map(|at| scale(&|motion| motion.known.iter().map(|known| known[at]).collect()))
                .collect(),
            // Differences need a following sample, so there is one less.
            accelerations: three(&|motion, k, axis| motion.unexplained_acceleration(k)[axis], 1),
        }
    }

    /// Scaled inputs of a step. They are not centred, so that zero motion and rudder are zero
    /// inputs.
    pub fn scale_inputs(&self, velocities: &[f64; 3], known: &[f64]) -> Vec<f64> {
        let own = velocities.iter().zip(&self.velocities);
        own.chain(known.iter().zip(&self.known)).map(|(value, scale)| value / scale).collect()
    }
}
