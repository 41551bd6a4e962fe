//! A recurrent cell: what it makes of an input and of its own state, and how its gradient goes
//! back. Neurons answer `x / sqrt(1 + x^2)` in place of the hyperbolic tangent, gates half of that
//! and a half in place of the logistic function (decision 20).

use serde::{Deserialize, Serialize};

/// The kinds of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Wakita 2022, Eq. 8: nothing comes of nothing.
    Rnn,
    /// Long short-term memory with a gate that forgets (Gers and others 2000).
    Lstm,
}

/// The state of a cell: its answer, and what it keeps to itself.
#[derive(Debug, Clone, PartialEq)]
pub struct CellState {
    /// Its answer.
    pub answer: Vec<f64>,
    /// What an LSTM keeps.
    pub kept: Vec<f64>,
}

/// A step of a cell, as its gradient needs it.
#[derive(Debug, Clone)]
pub struct CellStep {
    inputs: Vec<f64>,
    before: CellState,
    /// Answers and slopes of each block of neurons.
    blocks: Vec<Vec<(f64, f64)>>,
    /// What an LSTM keeps, through a neuron.
    squashed: Vec<(f64, f64)>,
}

/// Blocks of an LSTM: the gates of what enters, what stays and what is shown, and what could enter.
const ENTERS: usize = 0;
const STAYS: usize = 1;
const SHOWN: usize = 2;
const NEW: usize = 3;

/// A neuron's answer to its sum, and the slope there.
#[inline(always)]
pub fn neuron(sum: f64) -> (f64, f64) {
    let root = 1.0 / (1.0 + sum * sum).sqrt();
    (sum * root, root * root * root)
}

#[inline(always)]
fn gate(sum: f64) -> (f64, f64) {
    let (answer, slope) = neuron(sum);
    (0.5 + 0.5 * answer, 0.5 * slope)
}

impl CellState {
    /// Nothing remembered.
    pub fn empty(width: usize) -> Self {
        Self { answer: vec![0.0; width], kept: vec![0.0; width] }
    }
}

impl Cell {
    /// Blocks of neurons.
    pub(super) fn blocks(self) -> usize {
        match self {
            Self::Rnn => 1,
            Self::Lstm => 4,
        }
    }

    /// Numbers of one block: weights of inputs and of answers, and biases, neuron by neuron.
    fn block(inputs: usize, width: usize) -> usize {
        width * (inputs + width + 1)
    }

    /// Numbers of a cell.
    pub fn numbers(self, inputs: usize, width: usize) -> usize {
        self.blocks() * Self::block(inputs, width)
    }

    fn answer_of(self, block: usize, sum: f64) -> (f64, f64) {
        if self == Self::Lstm && block != NEW { gate(sum) } else { neuron(sum) }
    }

    /// Answers of a block's neurons in place of their sums.
    #[inline(always)]
    pub(super) fn answers<const N: usize>(self, block: usize, sums: &mut [f64; N]) {
        match self == Self::Lstm && block != NEW {
            true => sums.iter_mut().for_each(|sum| *sum = gate(*sum).0),
            false => sums.iter_mut().for_each(|sum| *sum = neuron(*sum).0),
        }
    }

    /// One step.
    pub fn forward(
        self,
        numbers: &[f64],
        inputs: &[f64],
        before: &CellState,
    ) -> (CellState, CellStep) {
        let width = before.answer.len();
        let row = inputs.len() + width + 1;
        let one = |(block, numbers): (usize, &[f64])| -> Vec<(f64, f64)> {
            let neuron = |weights: &[f64]| {
                let seen = inputs.iter().chain(&before.answer).zip(weights);
                let sum = weights[row - 1] + seen.map(|(x, w)| x * w).sum::<f64>();
                self.answer_of(block, sum)
            };
            numbers.chunks_exact(row).map(neuron).collect()
        };
        let blocks: Vec<Vec<(f64, f64)>> =
            numbers.chunks_exact(Self::block(inputs.len(), width)).enumerate().map(one).collect();
        let (state, squashed) = self.state(numbers, row, &blocks, before);
        (state, CellStep { inputs: inputs.to_vec(), before: before.clone(), blocks, squashed })
    }

    fn state(
        self,
        numbers: &[f64],
        row: usize,
        blocks: &[Vec<(f64, f64)>],
        before: &CellState,
    ) -> (CellState, Vec<(f64, f64)>) {
        let width = before.answer.len();
        match self {
            Self::Rnn => {
                let bias = |k: usize| neuron(numbers[(k + 1) * row - 1]).0;
                let answer = (0..width).map(|k| blocks[0][k].0 - bias(k)).collect();
                (CellState { answer, kept: vec![0.0; width] }, Vec::new())
            }
            Self::Lstm => {
                let of = |block: usize, k: usize| blocks[block][k].0;
                let kept: Vec<f64> = (0..width)
                    .map(|k| of(STAYS, k) * before.kept[k] + of(ENTERS, k) * of(NEW, k))
                    .collect();
                let squashed: Vec<(f64, f64)> = kept.iter().map(|x| neuron(*x)).collect();
                let answer = (0..width).map(|k| of(SHOWN, k) * squashed[k].0).collect();
                (CellState { answer, kept }, squashed)
            }
        }
    }

    /// How an error that changes with the state after a step changes with the state before it and
    /// with the inputs; the changes with the numbers are added to `gradient`.
    pub fn backward(
        self,
        numbers: &[f64],
        step: &CellStep,
        after: CellState,
        gradient: &mut [f64],
    ) -> (CellState, Vec<f64>) {
        let width = after.answer.len();
        let (sums, kept) = self.sums(step, &after);
        let row = step.inputs.len() + width + 1;
        let mut seen = vec![0.0; row - 1];
        let rows = numbers.chunks_exact(row).zip(gradient.chunks_exact_mut(row));
        for ((weights, gradient), sum) in rows.zip(sums.iter().flatten()) {
            let inputs = step.inputs.iter().chain(&step.before.answer);
            for ((slope, x), (back, weight)) in
                gradient.iter_mut().zip(inputs).zip(seen.iter_mut().zip(weights))
            {
                *slope += sum * x;
                *back += sum * weight;
            }
            gradient[row - 1] += sum;
        }
        if self == Self::Rnn {
            // The answer to nothing is taken off.
            for (k, blame) in after.answer.iter().enumerate() {
                let bias = (k + 1) * row - 1;
                gradient[bias] -= blame * neuron(numbers[bias]).1;
            }
        }
        let answer = seen.split_off(step.inputs.len());
        (CellState { answer, kept }, seen)
    }

    /// How the error changes with the sum of each neuron, and with what was kept before.
    fn sums(self, step: &CellStep, after: &CellState) -> (Vec<Vec<f64>>, Vec<f64>) {
        let width = after.answer.len();
        let of = |block: usize, k: usize| step.blocks[block][k];
        if self == Self::Rnn {
            let sums = (0..width).map(|k| after.answer[k] * of(0, k).1).collect();
            return (vec![sums], vec![0.0; width]);
        }
        let mut sums = vec![vec![0.0; width]; 4];
        let mut before = vec![0.0; width];
        for k in 0..width {
            let kept = after.kept[k] + after.answer[k] * of(SHOWN, k).0 * step.squashed[k].1;
            sums[SHOWN][k] = after.answer[k] * step.squashed[k].0 * of(SHOWN, k).1;
            sums[STAYS][k] = kept * step.before.kept[k] * of(STAYS, k).1;
            sums[ENTERS][k] = kept * of(NEW, k).0 * of(ENTERS, k).1;
            sums[NEW][k] = kept * of(ENTERS, k).0 * of(NEW, k).1;
            before[k] = kept * of(STAYS, k).0;
        }
        (sums, before)
    }
}
