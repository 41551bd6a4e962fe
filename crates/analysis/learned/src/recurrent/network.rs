//! Recurrent networks: a cell over a part of the past, and layers above it (Wakita 2022, Eqs. 8 and
//! 10).

use serde::{Deserialize, Serialize};

use super::cell::{CellState, CellStep, RecurrentCell};
use super::head::{self, HeadStep};
use crate::draws::RandomStream;

/// Length of the past that a network sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NetworkMemory {
    /// This number of steps, including the present one: Eq. 10.
    Steps(usize),
    /// The whole past: Eq. 8.
    All,
}

/// Structure of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkShape {
    /// Kind of cell.
    pub cell: RecurrentCell,
    /// Length of the past that the network sees.
    pub memory: NetworkMemory,
    /// Number of inputs of a step.
    pub inputs: usize,
    /// Number of neurons of the cell and of each layer.
    pub width: usize,
    /// Number of outputs.
    pub outputs: usize,
}

/// Recurrent network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecurrentNetwork {
    /// Structure of the network.
    pub shape: NetworkShape,
    /// Weights and biases: the cell's, then the layers'.
    pub numbers: Vec<f64>,
}

/// Network evaluated over some steps, with the values that its gradient needs.
pub struct UnrolledNetwork {
    /// Outputs at the last step.
    pub outputs: Vec<f64>,
    steps: Vec<CellStep>,
    head: HeadStep,
}

impl RecurrentNetwork {
    /// Creates a network with random weights, uniform within limits by the number of inputs and
    /// neurons (Glorot and Bengio 2010, Eq. 16), and biases of zero.
    pub fn with_random_weights(shape: NetworkShape, seed: u64) -> Self {
        let NetworkShape { cell, inputs, width, outputs, .. } = shape;
        let (of_cell, of_head) =
            (cell.parameter_count(inputs, width), head::parameter_count(width, outputs));
        let mut draws = RandomStream::new(seed, 0);
        let limit = |seen: usize| (6.0 / (seen + width) as f64).sqrt();
        let mut numbers = Vec::with_capacity(of_cell + of_head);
        let mut rows = |count: usize, seen: usize, bias: bool| {
            for _ in 0..count {
                numbers.extend((0..seen).map(|_| limit(seen) * draws.signed_unit()));
                numbers.extend(bias.then_some(0.0));
            }
        };
        rows(of_cell / (inputs + width + 1), inputs + width, true);
        rows(2 * width, width, true);
        // Order of the parameters: cell, two layers, outputs; the outputs have no bias.
        rows(outputs, width, false);
        Self { shape, numbers }
    }

    /// Parameters of the cell, and of the head.
    pub(super) fn split_parameters(&self) -> (&[f64], &[f64]) {
        self.numbers.split_at(self.shape.cell.parameter_count(self.shape.inputs, self.shape.width))
    }

    /// Index of the first step that is seen at a step.
    pub fn memory_start(&self, step: usize) -> usize {
        match self.shape.memory {
            NetworkMemory::Steps(steps) => (step + 1).saturating_sub(steps),
            NetworkMemory::All => 0,
        }
    }

    /// Evaluates the network over the given steps, starting with an empty memory.
    pub fn unroll_steps<'a>(&self, inputs: impl Iterator<Item = &'a [f64]>) -> UnrolledNetwork {
        let (cell, head) = self.split_parameters();
        let (mut state, mut steps) = (CellState::zeros(self.shape.width), Vec::new());
        for inputs in inputs {
            let (next, step) = self.shape.cell.propagate_forward(cell, inputs, &state);
            state = next;
            steps.push(step);
        }
        let (outputs, head) = head::propagate_forward(head, &state.answer, self.shape.outputs);
        UnrolledNetwork { outputs, steps, head }
    }

    /// Propagates error derivatives from the outputs to the inputs of each step, which are
    /// returned; derivatives with respect to the parameters are added to `gradient`.
    pub fn propagate_back(
        &self,
        unrolled: &UnrolledNetwork,
        blame: &[f64],
        gradient: &mut [f64],
    ) -> Vec<Vec<f64>> {
        let (cell, head) = self.split_parameters();
        let (of_cell, of_head) = gradient.split_at_mut(cell.len());
        let answer = head::propagate_back(head, &unrolled.head, blame, of_head);
        let mut after = CellState { answer, kept: vec![0.0; self.shape.width] };
        let mut seen = Vec::with_capacity(unrolled.steps.len());
        // Backwards in time; the derivatives of the parameters add up over the steps.
        for step in unrolled.steps.iter().rev() {
            let (before, inputs) = self.shape.cell.propagate_back(cell, step, after, of_cell);
            after = before;
            seen.push(inputs);
        }
        seen.reverse();
        seen
    }
}
