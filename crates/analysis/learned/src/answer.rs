//! Prediction of one output of a learned correction at an instant.

use sistership_model::branch::CorrectionOutput;
use sistership_simulation::branch::CorrectionInstant;

use crate::regressor::OutputRegressor;
use crate::sample::scale_input;

/// Largest number of inputs of an output: above the number of signals, as each occurs once.
pub const MOST_INPUTS: usize = 16;

/// Predicted acceleration, m/s2 (rad/s2), limited to the range of the targets in training.
pub fn predict_output(
    output: &CorrectionOutput,
    regressor: &OutputRegressor,
    instant: &CorrectionInstant,
) -> f64 {
    let mut inputs = [0.0; MOST_INPUTS];
    let count = output.inputs.len();
    let pairs = inputs.iter_mut().zip(&output.inputs);
    pairs.for_each(|(value, input)| *value = scale_input(input, instant));
    let [low, high] = output.range;
    (output.scale * regressor.predict(&inputs[..count])).clamp(low, high)
}
