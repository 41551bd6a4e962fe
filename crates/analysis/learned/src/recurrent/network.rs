//! Recurrent networks: a cell over a part of the past, and layers above it (Wakita 2022, Eqs. 8 and
//! 10).

use serde::{Deserialize, Serialize};

use super::cell::{Cell, CellState, CellStep};
use super::head::{self, HeadStep};
use crate::draws::Draws;

/// Length of the past that a network sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Memory {
    /// This number of steps, including the present one: Eq. 10.
    Steps(usize),
    /// The whole past: Eq. 8.
    All,
}

/// Structure of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Kind of cell.
    pub cell: Cell,
    /// Length of the past that the network sees.
    pub memory: Memory,
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
pub struct Recurrent {
    /// Structure of the network.
    pub shape: Shape,
    /// Weights and biases: the cell's, then the layers'.
    pub numbers: Vec<f64>,
}

/// Network evaluated over some steps, with the values that its gradient needs.
pub struct Unrolled {
    /// Outputs at the last step.
    pub outputs: Vec<f64>,
    steps: Vec<CellStep>,
    head: HeadStep,
}

impl Recurrent {
    /// Creates a network with random weights, uniform within limits by the number of inputs and
    /// neurons (Glorot and Bengio 2010, Eq. 16), and biases of zero.
    pub fn drawn(shape: Shape, seed: u64) -> Self {
        let Shape { cell, inputs, width, outputs, .. } = shape;
        let (of_cell, of_head) = (cell.numbers(inputs, width), head::numbers(width, outputs));
        let mut draws = Draws::new(seed, 0);
        let limit = |seen: usize| (6.0 / (seen + width) as f64).sqrt();
        let mut numbers = Vec::with_capacity(of_cell + of_head);
        let mut rows = |count: usize, seen: usize, bias: bool| {
            for _ in 0..count {
                numbers.extend((0..seen).map(|_| limit(seen) * draws.signed()));
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
    pub(super) fn parts(&self) -> (&[f64], &[f64]) {
        self.numbers.split_at(self.shape.cell.numbers(self.shape.inputs, self.shape.width))
    }

    /// Index of the first step that is seen at a step.
    pub fn sees_from(&self, step: usize) -> usize {
        match self.shape.memory {
            Memory::Steps(steps) => (step + 1).saturating_sub(steps),
            Memory::All => 0,
        }
    }

    /// Evaluates the network over the given steps, starting with an empty memory.
    pub fn unrolled<'a>(&self, inputs: impl Iterator<Item = &'a [f64]>) -> Unrolled {
        let (cell, head) = self.parts();
        let (mut state, mut steps) = (CellState::empty(self.shape.width), Vec::new());
        for inputs in inputs {
            let (next, step) = self.shape.cell.forward(cell, inputs, &state);
            state = next;
            steps.push(step);
        }
        let (outputs, head) = head::forward(head, &state.answer, self.shape.outputs);
        Unrolled { outputs, steps, head }
    }

    /// Propagates error derivatives from the outputs to the inputs of each step, which are
    /// returned; derivatives with respect to the parameters are added to `gradient`.
    pub fn back(&self, unrolled: &Unrolled, blame: &[f64], gradient: &mut [f64]) -> Vec<Vec<f64>> {
        let (cell, head) = self.parts();
        let (of_cell, of_head) = gradient.split_at_mut(cell.len());
        let answer = head::backward(head, &unrolled.head, blame, of_head);
        let mut after = CellState { answer, kept: vec![0.0; self.shape.width] };
        let mut seen = Vec::with_capacity(unrolled.steps.len());
        // Backwards in time; the derivatives of the parameters add up over the steps.
        for step in unrolled.steps.iter().rev() {
            let (before, inputs) = self.shape.cell.backward(cell, step, after, of_cell);
            after = before;
            seen.push(inputs);
        }
        seen.reverse();
        seen
    }
}
