//! Permutation importance of the inputs of a learned correction: the rise of its error where one
//! input is shuffled among the samples (Breiman 2001, Sec. 10).

use serde::Serialize;
use sistership_model::branch::{Branch, Signal};
use sistership_model::coefficient::Axis;

use crate::dependence::rise;
use crate::draws::Draws;
use crate::rows::Row;
use crate::train::sample_of;
use crate::weights::Weights;

/// Permutation importance of one input for one output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Importance {
    /// Axis of the acceleration.
    pub axis: Axis,
    /// Input signal.
    pub signal: Signal,
    /// Rise of the mean squared error, divided by the variance of the targets in training.
    pub rise: f64,
}

/// Returns the permutation importance of each input of each output, in their order. Rows that were
/// not used in training are more informative.
pub fn importance(branch: &Branch, weights: &Weights, rows: &[Row], seed: u64) -> Vec<Importance> {
    let mut draws = Draws::new(seed, 0);
    let mut all = Vec::new();
    for (output, regressor) in branch.outputs.iter().zip(&weights.outputs) {
        let mut sample = sample_of(rows, output, branch.mode);
        for (place, input) in output.inputs.iter().enumerate() {
            // Targets are scaled by their standard deviation in training, so the rise is relative
            // to that variance.
            let rise = rise(regressor, &mut sample, place, &mut draws);
            all.push(Importance { axis: output.axis, signal: input.signal, rise });
        }
    }
    all
}
