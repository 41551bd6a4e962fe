//! A recurrent network: a cell over some of the past, and layers above it (Wakita 2022, Eqs. 8 and
//! 10).

use serde::{Deserialize, Serialize};

use super::cell::{Cell, CellState, CellStep};
use super::head::{self, HeadStep};
use crate::draws::Draws;

/// How much of the past a network sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Memory {
    /// So many steps, the present one among them: Eq. 10.
    Steps(usize),
    /// All of it: Eq. 8.
    All,
}

/// What a network is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// The cell.
    pub cell: Cell,
    /// How much of the past it sees.
    pub memory: Memory,
    /// Inputs of a step.
    pub inputs: usize,
    /// Neurons of the cell and of each layer.
    pub width: usize,
    /// Outputs.
    pub outputs: usize,
}

/// A recurrent network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recurrent {
    /// What it is made of.
    pub shape: Shape,
    /// Its weights and biases: the cell's, then the layers'.
    pub numbers: Vec<f64>,
}

/// A network over some steps, as its gradient needs it.
pub struct Unrolled {
    /// The outputs at the last step.
    pub outputs: Vec<f64>,
    steps: Vec<CellStep>,
    head: HeadStep,
}

impl Recurrent {
    /// Small random weights, by the fan in and out (Glorot and Bengio 2010, Eq. 16), and no biases.
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
        rows(outputs, width, false);
        Self { shape, numbers }
    }

    /// The numbers of the cell, and of what stands above it.
    pub(super) fn parts(&self) -> (&[f64], &[f64]) {
        self.numbers.split_at(self.shape.cell.numbers(self.shape.inputs, self.shape.width))
    }

    /// Where the past that is seen at a step begins.
    pub fn sees_from(&self, step: usize) -> usize {
        match self.shape.memory {
            Memory::Steps(steps) => (step + 1).saturating_sub(steps),
            Memory::All => 0,
        }
    }

    /// The outputs after the given steps, from nothing remembered.
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

    /// How an error that changes with the outputs changes with the inputs of each step; the changes
    /// with the numbers are added to `gradient`.
    pub fn back(&self, unrolled: &Unrolled, blame: &[f64], gradient: &mut [f64]) -> Vec<Vec<f64>> {
        let (cell, head) = self.parts();
        let (of_cell, of_head) = gradient.split_at_mut(cell.len());
        let answer = head::backward(head, &unrolled.head, blame, of_head);
        let mut after = CellState { answer, kept: vec![0.0; self.shape.width] };
        let mut seen = Vec::with_capacity(unrolled.steps.len());
        for step in unrolled.steps.iter().rev() {
            let (before, inputs) = self.shape.cell.backward(cell, step, after, of_cell);
            after = before;
            seen.push(inputs);
        }
        seen.reverse();
        seen
    }
}
