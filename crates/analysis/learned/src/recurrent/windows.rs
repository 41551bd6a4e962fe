//! Step-by-step evaluation of a network: every window of the past that a later output will depend
//! on is carried on together with the present one, side by side, instead of evaluating the steps of
//! each window again.
//!
//! The output with a memory of `m` steps is that of a cell which started with an empty memory `m`
//! steps ago (Wakita 2022, Eq. 10). At any time `m` such cells are active, one started at each of
//! the last `m` steps. They have the weights and the present input in common, and differ in their
//! states alone; a lane is one of them. Sums are taken in the order of the cell's own forward step,
//! so the outputs are the same to the last bit.

use super::cell::{RecurrentCell, activate_neuron};
use super::head;
use super::network::{NetworkMemory, NetworkShape, RecurrentNetwork};
use sistership_simulation::simd::{SimdKernel, dispatch_simd};

/// Number of cells that are computed together.
const LANES: usize = 4;

/// One number of each of these cells.
type LaneValues = [f64; LANES];

/// Active cells of a network.
pub struct ActiveWindows<'a> {
    network: &'a RecurrentNetwork,
    /// Number of active cells.
    cells: usize,
    /// Number of steps so far.
    steps: usize,
    /// Groups of cells that are computed together.
    groups: Vec<CellGroup>,
}

/// States of a group of cells.
struct CellGroup {
    /// Outputs of the cells, neuron by neuron.
    answers: Vec<LaneValues>,
    /// Internal memory of LSTM cells, likewise.
    kept: Vec<LaneValues>,
    /// Outputs of each block's neurons, likewise, block by block.
    blocks: Vec<LaneValues>,
}

impl<'a> ActiveWindows<'a> {
    /// Creates the cells before the first step.
    pub fn new(network: &'a RecurrentNetwork) -> Self {
        let cells = match network.shape.memory {
            NetworkMemory::Steps(steps) => steps.max(1),
            NetworkMemory::All => 1,
        };
        let groups = (0..cells.div_ceil(LANES)).map(|_| CellGroup::with_zeros(network)).collect();
        Self { network, cells, steps: 0, groups }
    }

    /// Advances all cells by one step. Returns the network's outputs.
    pub fn advance_step(&mut self, inputs: &[f64]) -> Vec<f64> {
        if self.network.shape.memory != NetworkMemory::All {
            // Cells are reused in turn: the oldest one has left the memory and starts again.
            let begun = self.steps % self.cells;
            self.groups[begun / LANES].reset_lane(begun % LANES);
        }
        // Runs with the widest SIMD instructions that the processor has.
        dispatch_simd(WindowStep { windows: self, inputs });
        // The output is that of the cell which started at the first step of the memory.
        let seen = self.network.memory_start(self.steps) % self.cells;
        self.steps += 1;
        let answers = &self.groups[seen / LANES].answers;
        let answer: Vec<f64> = answers.iter().map(|lanes| lanes[seen % LANES]).collect();
        let (_, head) = self.network.split_parameters();
        head::propagate_forward(head, &answer, self.network.shape.outputs).0
    }
}

/// One step of all cells, for SIMD dispatch.
struct WindowStep<'s, 'a> {
    windows: &'s mut ActiveWindows<'a>,
    inputs: &'s [f64],
}

impl SimdKernel for WindowStep<'_, '_> {
    #[inline(always)]
    fn run(mut self) {
        let network = self.windows.network;
        self.evaluate_blocks(network);
        for group in &mut self.windows.groups {
            match network.shape.cell {
                RecurrentCell::Rnn => group.answer_less_bias(network, self.inputs.len()),
                RecurrentCell::Lstm => group.answer_by_gates(),
            }
        }
    }
}

impl WindowStep<'_, '_> {
    /// Evaluates the neurons of every block; the contribution of the inputs is the same for all
    /// cells.
    #[inline(always)]
    fn evaluate_blocks(&mut self, network: &RecurrentNetwork) {
        let (NetworkShape { cell, width, .. }, (numbers, _)) =
            (network.shape, network.split_parameters());
        let row = self.inputs.len() + width + 1;
        for (block, rows) in numbers.chunks_exact(row * width).enumerate() {
            for (neuron, weights) in rows.chunks_exact(row).enumerate() {
                let (of_inputs, of_answers) = weights.split_at(self.inputs.len());
                let common: f64 = self.inputs.iter().zip(of_inputs).map(|(x, w)| x * w).sum();
                for group in &mut self.windows.groups {
                    let mut sums = [common; LANES];
                    for (weight, answers) in of_answers.iter().zip(&group.answers) {
                        sums.iter_mut().zip(answers).for_each(|(sum, x)| *sum += x * weight);
                    }
                    sums.iter_mut().for_each(|sum| *sum += weights[row - 1]);
                    cell.activate_sums(block, &mut sums);
                    group.blocks[block * width + neuron] = sums;
                }
            }
        }
    }
}

impl CellGroup {
    /// Group of cells with an empty memory.
    fn with_zeros(network: &RecurrentNetwork) -> Self {
        let width = network.shape.width;
        let nothing = |count: usize| vec![[0.0; LANES]; count];
        let blocks = nothing(network.shape.cell.block_count() * width);
        Self { answers: nothing(width), kept: nothing(width), blocks }
    }

    /// Resets the memory of a cell.
    fn reset_lane(&mut self, lane: usize) {
        self.answers.iter_mut().chain(&mut self.kept).for_each(|lanes| lanes[lane] = 0.0);
    }

    /// Outputs of simple recurrent cells: the output at zero input is subtracted.
    #[inline(always)]
    fn answer_less_bias(&mut self, network: &RecurrentNetwork, inputs: usize) {
        let (cell, _) = network.split_parameters();
        let row = inputs + network.shape.width + 1;
        let neurons = self.answers.iter_mut().zip(&self.blocks);
        for ((answers, sums), weights) in neurons.zip(cell.chunks_exact(row)) {
            let bias = activate_neuron(weights[row - 1]).0;
            *answers = std::array::from_fn(|lane| sums[lane] - bias);
        }
    }

    /// Outputs and memory of LSTM cells.
    #[inline(always)]
    fn answer_by_gates(&mut self) {
        let mut blocks = self.blocks.chunks_exact(self.answers.len());
        let mut next = || blocks.next().unwrap_or_default();
        // In the order of the cell's blocks.
        let [enters, stays, shown, new]: [&[LaneValues]; 4] = std::array::from_fn(|_| next());
        for (k, (answers, kept)) in self.answers.iter_mut().zip(&mut self.kept).enumerate() {
            for lane in 0..LANES {
                kept[lane] = stays[k][lane] * kept[lane] + enters[k][lane] * new[k][lane];
            }
            *answers = std::array::from_fn(|lane| shown[k][lane] * activate_neuron(kept[lane]).0);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn answers_are_those_of_each_stretch_gone_through_anew() {
        let inputs: Vec<Vec<f64>> = (0..40)
            .map(|k| (0..5).map(|place| (0.37 * k as f64 + f64::from(place)).sin()).collect())
            .collect();
        for cell in [RecurrentCell::Rnn, RecurrentCell::Lstm] {
            for memory in [NetworkMemory::Steps(1), NetworkMemory::Steps(7), NetworkMemory::All] {
                let shape = NetworkShape { cell, memory, inputs: 5, width: 6, outputs: 3 };
                let mut network = RecurrentNetwork::with_random_weights(shape, 3);
                network
                    .numbers
                    .iter_mut()
                    .enumerate()
                    .for_each(|(k, w)| *w += 0.01 * k as f64 % 0.1);
                let mut windows = ActiveWindows::new(&network);
                for k in 0..inputs.len() {
                    let seen = inputs[network.memory_start(k)..=k].iter().map(Vec::as_slice);
                    assert_eq!(
                        windows.advance_step(&inputs[k]),
                        network.unroll_steps(seen).outputs,
                        "{shape:?}"
                    );
                }
            }
        }
    }
}
