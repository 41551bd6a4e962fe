//! Prediction of one output of a learned correction at an instant.

use sistership_model::branch::BranchOutput;
use sistership_simulation::branch::Instant;

use crate::regressor::Regressor;
use crate::sample::scaled;

/// Largest number of inputs of an output: above the number of signals, as each occurs once.
pub const MOST_INPUTS: usize = 16;

/// Predicted acceleration, m/s2 (rad/s2), limited to the range of the targets in training.
pub fn answer(output: &BranchOutput, regressor: &Regressor, instant: &Instant) -> f64 {
    let mut inputs = [0.0; MOST_INPUTS];
    let count = output.inputs.len();
    let pairs = inputs.iter_mut().zip(&output.inputs);
    pairs.for_each(|(value, input)| *value = scaled(input, instant));
    let [low, high] = output.range;
    (output.scale * regressor.answer(&inputs[..count])).clamp(low, high)
}
