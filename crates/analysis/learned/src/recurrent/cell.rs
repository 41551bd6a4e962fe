//! Recurrent cells: forward step and backpropagation. The activation function is `x / sqrt(1 +
//! x^2)` in place of the hyperbolic tangent, and a gate is one half plus half of that in place of
//! the logistic function (decision 20).

use serde::{Deserialize, Serialize};

/// Kind of recurrent cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecurrentCell {
    /// Simple recurrent cell without offset: zero input gives zero output (Wakita 2022, Eq. 8).
    Rnn,
    /// Long short-term memory with a forget gate (Gers and others 2000).
    Lstm,
}

/// State of a cell: its output and its internal memory.
#[derive(Debug, Clone, PartialEq)]
pub struct CellState {
    /// Output of the cell.
    pub answer: Vec<f64>,
    /// Internal memory of an LSTM.
    pub kept: Vec<f64>,
}

/// Intermediate values of a step of a cell, as needed by its gradient.
#[derive(Debug, Clone)]
pub struct CellStep {
    inputs: Vec<f64>,
    before: CellState,
    /// Outputs and derivatives of each block of neurons.
    blocks: Vec<Vec<(f64, f64)>>,
    /// Activation of the internal memory of an LSTM, and its derivative.
    squashed: Vec<(f64, f64)>,
}

/// Indices of the blocks of an LSTM: input gate, forget gate, output gate, and candidate memory.
const INPUT_GATE: usize = 0;
const FORGET_GATE: usize = 1;
const OUTPUT_GATE: usize = 2;
const CANDIDATE_MEMORY: usize = 3;

/// Activation of a neuron at its weighted sum, and the derivative there.
#[inline(always)]
pub fn activate_neuron(sum: f64) -> (f64, f64) {
    let root = 1.0 / (1.0 + sum * sum).sqrt();
    (sum * root, root * root * root)
}

/// Activation of a gate, between 0 and 1, and the derivative there.
#[inline(always)]
fn activate_gate(sum: f64) -> (f64, f64) {
    let (answer, slope) = activate_neuron(sum);
    // Maps the activation from (-1, 1) to (0, 1).
    (0.5 + 0.5 * answer, 0.5 * slope)
}

impl CellState {
    /// State of zeros: no memory of the past.
    pub fn zeros(width: usize) -> Self {
        Self { answer: vec![0.0; width], kept: vec![0.0; width] }
    }
}

impl RecurrentCell {
    /// Number of blocks of neurons.
    pub(super) fn block_count(self) -> usize {
        match self {
            Self::Rnn => 1,
            Self::Lstm => 4,
        }
    }

    /// Number of parameters of one block: for each neuron, weights of inputs and of outputs, and a
    /// bias.
    fn block_size(inputs: usize, width: usize) -> usize {
        width * (inputs + width + 1)
    }

    /// Number of parameters of a cell.
    pub fn parameter_count(self, inputs: usize, width: usize) -> usize {
        self.block_count() * Self::block_size(inputs, width)
    }

    /// Activation of a neuron of a block, and its derivative: the blocks of an LSTM are gates,
    /// except the candidate memory.
    fn activate_block(self, block: usize, sum: f64) -> (f64, f64) {
        if self == Self::Lstm && block != CANDIDATE_MEMORY {
            activate_gate(sum)
        } else {
            activate_neuron(sum)
        }
    }

    /// Replaces the weighted sums of a block's neurons by their activations.
    #[inline(always)]
    pub(super) fn activate_sums<const N: usize>(self, block: usize, sums: &mut [f64; N]) {
        match self == Self::Lstm && block != CANDIDATE_MEMORY {
            true => sums.iter_mut().for_each(|sum| *sum = activate_gate(*sum).0),
            false => sums.iter_mut().for_each(|sum| *sum = activate_neuron(*sum).0),
        }
    }

    /// Evaluates one step from the state before it. Returns the next state, and what the gradient
    /// needs.
    pub fn propagate_forward(
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
                self.activate_block(block, sum)
            };
            numbers.chunks_exact(row).map(neuron).collect()
        };
        let blocks: Vec<Vec<(f64, f64)>> = numbers
            .chunks_exact(Self::block_size(inputs.len(), width))
            .enumerate()
            .map(one)
            .collect();
        let (state, squashed) = self.next_state(numbers, row, &blocks, before);
        (state, CellStep { inputs: inputs.to_vec(), before: before.clone(), blocks, squashed })
    }

    /// State after a step, from the outputs of the blocks, with the activation of the memory.
    fn next_state(
        self,
        numbers: &[f64],
        row: usize,
        blocks: &[Vec<(f64, f64)>],
        before: &CellState,
    ) -> (CellState, Vec<(f64, f64)>) {
        let width = before.answer.len();
        match self {
            Self::Rnn => {
                // Subtracting the activation of the bias makes the output zero at zero input and
                // state.
                let bias = |k: usize| activate_neuron(numbers[(k + 1) * row - 1]).0;
                let answer = (0..width).map(|k| blocks[0][k].0 - bias(k)).collect();
                (CellState { answer, kept: vec![0.0; width] }, Vec::new())
            }
            Self::Lstm => {
                let of = |block: usize, k: usize| blocks[block][k].0;
                let kept: Vec<f64> = (0..width)
                    // c = forget * c_before + input * candidate; the output is the output gate
                    // times its activation.
                    .map(|k| {
                        of(FORGET_GATE, k) * before.kept[k]
                            + of(INPUT_GATE, k) * of(CANDIDATE_MEMORY, k)
                    })
                    .collect();
                let squashed: Vec<(f64, f64)> = kept.iter().map(|x| activate_neuron(*x)).collect();
                let answer = (0..width).map(|k| of(OUTPUT_GATE, k) * squashed[k].0).collect();
                (CellState { answer, kept }, squashed)
            }
        }
    }

    /// Propagates error derivatives from the state after a step to the state before it and to the
    /// inputs, which are returned; derivatives with respect to the parameters are added to
    /// `gradient`.
    pub fn propagate_back(
        self,
        numbers: &[f64],
        step: &CellStep,
        after: CellState,
        gradient: &mut [f64],
    ) -> (CellState, Vec<f64>) {
        let width = after.answer.len();
        let (sums, kept) = self.sum_derivatives(step, &after);
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
            // The output at zero input is subtracted in the forward step, so the bias has a second
            // path.
            for (k, blame) in after.answer.iter().enumerate() {
                let bias = (k + 1) * row - 1;
                gradient[bias] -= blame * activate_neuron(numbers[bias]).1;
            }
        }
        // The weights of a neuron are those of the inputs, then those of the cell's outputs.
        let answer = seen.split_off(step.inputs.len());
        (CellState { answer, kept }, seen)
    }

    /// Error derivatives with respect to the weighted sum of each neuron, and to the memory before
    /// the step.
    fn sum_derivatives(self, step: &CellStep, after: &CellState) -> (Vec<Vec<f64>>, Vec<f64>) {
        let width = after.answer.len();
        let of = |block: usize, k: usize| step.blocks[block][k];
        if self == Self::Rnn {
            let sums = (0..width).map(|k| after.answer[k] * of(0, k).1).collect();
            return (vec![sums], vec![0.0; width]);
        }
        let mut sums = vec![vec![0.0; width]; 4];
        let mut before = vec![0.0; width];
        for k in 0..width {
            // The memory acts on the error directly and through the output of the cell.
            let kept = after.kept[k] + after.answer[k] * of(OUTPUT_GATE, k).0 * step.squashed[k].1;
            sums[OUTPUT_GATE][k] = after.answer[k] * step.squashed[k].0 * of(OUTPUT_GATE, k).1;
            sums[FORGET_GATE][k] = kept * step.before.kept[k] * of(FORGET_GATE, k).1;
            sums[INPUT_GATE][k] = kept * of(CANDIDATE_MEMORY, k).0 * of(INPUT_GATE, k).1;
            sums[CANDIDATE_MEMORY][k] = kept * of(INPUT_GATE, k).0 * of(CANDIDATE_MEMORY, k).1;
            before[k] = kept * of(FORGET_GATE, k).0;
        }
        (sums, before)
    }
}
