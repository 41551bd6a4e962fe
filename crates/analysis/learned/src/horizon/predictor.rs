//! Prediction with a trained network.

use serde::{Deserialize, Serialize};

use super::scaling::ColumnScaling;
use crate::recurrent::RecurrentNetwork;

/// Network with the scaling of its inputs and outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackPredictor {
    pub(super) network: RecurrentNetwork,
    pub(super) inputs: ColumnScaling,
    pub(super) answers: ColumnScaling,
    /// Root mean squared error of each output on the validation examples, m.
    pub(super) spread_m: Vec<f64>,
    /// Mean squared error on the validation examples after each epoch, in standard deviations
    /// squared.
    pub(super) validation: Vec<f64>,
}

impl TrackPredictor {
    /// Predicted correction of the foundation's positions, ahead and then to starboard, m, limited
    /// to the range of the training data. `inputs` are those of an example.
    pub fn predict_correction(&self, inputs: &[Vec<f64>]) -> Vec<f64> {
        let scaled: Vec<Vec<f64>> = inputs.iter().map(|row| self.inputs.scale_row(row)).collect();
        let unrolled = self.network.unroll_steps(scaled.iter().map(Vec::as_slice));
        self.answers.unscale_bounded(&unrolled.outputs)
    }

    /// Root mean squared error of each output on the validation examples, m.
    pub fn spread_m(&self) -> &[f64] {
        &self.spread_m
    }

    /// Number of epochs of the training, and the least mean squared error on the validation
    /// examples.
    pub fn training_summary(&self) -> (usize, f64) {
        let least = self.validation.iter().copied().fold(f64::INFINITY, f64::min);
        (self.validation.len(), least)
    }
}
