//! Learned correction at the samples of a block: its addition to the law's accelerations, and its
//! effect on their derivatives.
//!
//! With `a(x)` the law's accelerations and `c(x, a)` the correction, those of the ship are `a + c`.
//! Their derivative with any argument of the law is `(I + dc/da) da`, to which `dc/dx` is added for
//! states and inputs on which the correction itself depends. So coefficients and effects keep
//! acting on the law around it, and where a correction replaces the law they act by that much less.

use std::sync::Arc;

use sistership_simulation::branch::{AdditionGradient, CorrectionInstant, CorrectionModel};
use sistership_simulation::tape::LaneValues;

use super::lanes::LANES;

/// A learned correction, and the indices of its inputs among those of the law.
#[derive(Debug, Clone)]
pub(super) struct AttachedCorrection {
    pub learned: Arc<dyn CorrectionModel>,
    pub delta: Option<usize>,
    pub n: Option<usize>,
}

/// Velocities that a correction changes, in the order of the axes.
const VELOCITIES: usize = 3;

/// The correction at a block of samples.
pub(super) struct CorrectionBlock<'a> {
    correction: &'a AttachedCorrection,
    gradients: [AdditionGradient; LANES],
}

impl<'a> CorrectionBlock<'a> {
    pub fn new(correction: &'a AttachedCorrection) -> Self {
        Self { correction, gradients: [AdditionGradient::default(); LANES] }
    }

    /// Evaluates the correction where the law gives `rates`, and adds it to them. `velocities` are
    /// u, v, r, `inputs` those of the law.
    pub fn add_to_rates(
        &mut self,
        velocities: [LaneValues<LANES>; VELOCITIES],
        inputs: &[LaneValues<LANES>],
        rates: &mut [LaneValues<LANES>],
    ) {
        let at = |place: Option<usize>, lane: usize| place.map_or(0.0, |place| inputs[place][lane]);
        for lane in 0..LANES {
            let instant = CorrectionInstant {
                velocities: velocities.map(|velocity| velocity[lane]),
                delta_rad: at(self.correction.delta, lane),
                n_rps: at(self.correction.n, lane),
                accelerations: [rates[0][lane], rates[1][lane], rates[2][lane]],
            };
            let added = self.correction.learned.rate_additions(&instant);
            self.gradients[lane] = self.correction.learned.addition_gradient(&instant);
            rates.iter_mut().zip(added).for_each(|(rate, added)| rate[lane] += added);
        }
    }

    /// Turns derivatives of the law's accelerations into those of the ship's: rows of `columns`
    /// numbers, one for each axis.
    pub fn apply_chain_rule(&self, lane: usize, rows: &mut [f64], columns: usize) {
        let by = &self.gradients[lane].by_acceleration;
        // A correction that does not depend on the law's accelerations changes no derivative here.
        if by.iter().flatten().all(|slope| *slope == 0.0) {
            return;
        }
        for column in 0..columns {
            // The law's derivatives are copied first, as every row depends on all of them.
            let law: [f64; VELOCITIES] = std::array::from_fn(|axis| rows[axis * columns + column]);
            for (axis, slopes) in by.iter().enumerate() {
                let more: f64 = slopes.iter().zip(law).map(|(slope, law)| slope * law).sum();
                rows[axis * columns + column] += more;
            }
        }
    }

    /// Adds the derivatives of the correction with the velocities, which are the first states.
    pub fn add_velocity_slopes(&self, lane: usize, jacobian: &mut [f64], states: usize) {
        for (axis, slopes) in self.gradients[lane].by_velocity.iter().enumerate() {
            let row = &mut jacobian[axis * states..][..VELOCITIES];
            row.iter_mut().zip(slopes).for_each(|(to, slope)| *to += slope);
        }
    }

    /// Derivatives with an input of the law, by axis; none where the correction does not depend on
    /// it.
    pub fn input_slopes(&self, lane: usize, input: usize) -> Option<[f64; VELOCITIES]> {
        let AttachedCorrection { delta, n, .. } = *self.correction;
        match Some(input) {
            found if found == delta => Some(self.gradients[lane].by_delta),
            found if found == n => Some(self.gradients[lane].by_n),
            _ => None,
        }
    }
}

#[cfg(test)]
#[path = "correction_tests.rs"]
mod tests;
