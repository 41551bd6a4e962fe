//! What an output of a correction answers at an instant.

use sistership_model::branch::BranchOutput;
use sistership_simulation::branch::Instant;

use crate::regressor::Regressor;
use crate::sample::scaled;

/// Most inputs of an output: each signal once, with room.
pub const MOST_INPUTS: usize = 16;

/// What an output answers, m/s2 (rad/s2), within what its training held.
pub fn answer(output: &BranchOutput, regressor: &Regressor, instant: &Instant) -> f64 {
    let mut inputs = [0.0; MOST_INPUTS];
    let count = output.inputs.len();
    let pairs = inputs.iter_mut().zip(&output.inputs);
    pairs.for_each(|(value, input)| *value = scaled(input, instant));
    let [low, high] = output.range;
    (output.scale * regressor.answer(&inputs[..count])).clamp(low, high)
}
