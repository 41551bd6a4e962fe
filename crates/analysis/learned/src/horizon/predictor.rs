//! A network that was trained, as it is asked.

use serde::{Deserialize, Serialize};

use super::scaling::Scaling;
use crate::recurrent::Recurrent;

/// A network with what its inputs and answers are scaled by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Predictor {
    pub(super) network: Recurrent,
    pub(super) inputs: Scaling,
    pub(super) answers: Scaling,
    /// Root mean square of what each answer lacked on examples kept for validation, m.
    pub(super) spread_m: Vec<f64>,
    /// Mean square of what it lacked there after each epoch, in deviations.
    pub(super) validation: Vec<f64>,
}

impl Predictor {
    /// What is to be put to the foundation's positions ahead, then to those to starboard, m: never
    /// more than what training held. `inputs` are as [`super::Example`] has them.
    pub fn answer(&self, inputs: &[Vec<f64>]) -> Vec<f64> {
        let scaled: Vec<Vec<f64>> = inputs.iter().map(|row| self.inputs.scaled(row)).collect();
        let unrolled = self.network.unrolled(scaled.iter().map(Vec::as_slice));
        self.answers.bounded(&unrolled.outputs)
    }

    /// Root mean square of what each answer lacked on examples that training did not see, m.
    pub fn spread_m(&self) -> &[f64] {
        &self.spread_m
    }

    /// Epochs that were sailed through, and the least mean square on examples kept for validation.
    pub fn epochs(&self) -> (usize, f64) {
        let least = self.validation.iter().copied().fold(f64::INFINITY, f64::min);
        (self.validation.len(), least)
    }
}
