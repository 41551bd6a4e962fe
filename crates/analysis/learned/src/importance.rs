//! Permutation importance of the inputs of a learned correction: the rise of its error where one
//! input is shuffled among the samples (Breiman 2001, Sec. 10).

use serde::Serialize;
use sistership_model::branch::{CorrectionDocument, Signal};
use sistership_model::coefficient::Axis;

use crate::dependence::shuffled_error_rise;
use crate::draws::RandomStream;
use crate::rows::WindowRow;
use crate::train::output_sample;
use crate::weights::CorrectionWeights;

/// Permutation importance of one input for one output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct InputImportance {
    /// Axis of the acceleration.
    pub axis: Axis,
    /// Input signal.
    pub signal: Signal,
    /// Rise of the mean squared error, divided by the variance of the targets in training.
    pub rise: f64,
}

/// Returns the permutation importance of each input of each output, in their order. Rows that were
/// not used in training are more informative.
pub fn permutation_importance(
    branch: &CorrectionDocument,
    weights: &CorrectionWeights,
    rows: &[WindowRow],
    seed: u64,
) -> Vec<InputImportance> {
    let mut draws = RandomStream::new(seed, 0);
    let mut all = Vec::new();
    for (output, regressor) in branch.outputs.iter().zip(&weights.outputs) {
        let mut sample = output_sample(rows, output, branch.mode);
        for (place, input) in output.inputs.iter().enumerate() {
            // Targets are scaled by their standard deviation in training, so the rise is relative
            // to that variance.
            let rise = shuffled_error_rise(regressor, &mut sample, place, &mut draws);
            all.push(InputImportance { axis: output.axis, signal: input.signal, rise });
        }
    }
    all
}
