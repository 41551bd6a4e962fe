//! Share of a learned correction along a motion.

use crate::branch::CorrectionInstant;
use crate::ship::Ship;
use crate::state::{Trajectory, at};

impl Ship {
    /// Mean share of the learned correction over a motion, 0 to 1; `None` for a ship without one,
    /// or for a motion without samples.
    pub fn mean_correction_share(&self, track: &Trajectory) -> Option<f64> {
        let branch = self.learned_correction()?;
        let share = |k: usize| {
            let state = &track.states[k];
            branch.active_share(&CorrectionInstant {
                velocities: [at::U, at::V, at::R].map(|place| state[place]),
                delta_rad: if self.has_rudder() { state[at::DELTA] } else { 0.0 },
                n_rps: if self.has_propeller() { track.n_rps[k] } else { 0.0 },
                // The share depends on the distance from the domain only, not on the accelerations.
                accelerations: [0.0; 3],
            })
        };
        let count = track.states.len();
        (count > 0).then(|| (0..count).map(share).sum::<f64>() / count as f64)
    }
}
