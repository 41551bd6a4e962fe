//! Step-by-step evaluation of a network: every window of the past that a later output will depend
//! on is carried on together with the present one, side by side, instead of evaluating the steps of
//! each window again.
//!
//! The output with a memory of `m` steps is that of a cell which started with an empty memory `m`
//! steps ago (Wakita 2022, Eq. 10). At any time `m` such cells are active, one started at each of
//! the last `m` steps. They have the weights and the present input in common, and differ in their
//! states alone; a lane is one of them. Sums are taken in the order of the cell's own forward step,
//! so the outputs are the same to the last bit.

use super::cell::{Cell, neuron};
use super::head;
use super::network::{Memory, Recurrent, Shape};
use sistership_simulation::wide::{Wide, widest};

/// Number of cells that are computed together.
const LANES: usize = 4;

/// One number of each of these cells.
type Lanes = [f64; LANES];

/// Active cells of a network.
pub struct Windows<'a> {
    network: &'a Recurrent,
    /// Number of active cells.
    cells: usize,
    /// Number of steps so far.
    steps: usize,
    /// Groups of cells that are computed together.
    groups: Vec<Group>,
}

/// States of a group of cells.
struct Group {
    /// Outputs of the cells, neuron by neuron.
    answers: Vec<Lanes>,
    /// Internal memory of LSTM cells, likewise.
    kept: Vec<Lanes>,
    /// Outputs of each block's neurons, likewise, block by block.
    blocks: Vec<Lanes>,
}

impl<'a> Windows<'a> {
    /// Creates the cells before the first step.
    pub fn new(network: &'a Recurrent) -> Self {
        let cells = match network.shape.memory {
            Memory::Steps(steps) => steps.max(1),
            Memory::All => 1,
        };
        let groups = (0..cells.div_ceil(LANES)).map(|_| Group::empty(network)).collect();
        Self { network, cells, steps: 0, groups }
    }

    /// Advances all cells by one step. Returns the network's outputs.
    pub fn step(&mut self, inputs: &[f64]) -> Vec<f64> {
        if self.network.shape.memory != Memory::All {
            // Cells are reused in turn: the oldest one has left the memory and starts again.
            let begun = self.steps % self.cells;
            self.groups[begun / LANES].forget(begun % LANES);
        }
        // Runs with the widest SIMD instructions that the processor has.
        widest(Step { windows: self, inputs });
        // The output is that of the cell which started at the first step of the memory.
        let seen = self.network.sees_from(self.steps) % self.cells;
        self.steps += 1;
        let answers = &self.groups[seen / LANES].answers;
        let answer: Vec<f64> = answers.iter().map(|lanes| lanes[seen % LANES]).collect();
        let (_, head) = self.network.parts();
        head::forward(head, &answer, self.network.shape.outputs).0
    }
}

/// One step of all cells, for SIMD dispatch.
struct Step<'s, 'a> {
    windows: &'s mut Windows<'a>,
    inputs: &'s [f64],
}

impl Wide for Step<'_, '_> {
    #[inline(always)]
    fn go(mut self) {
        let network = self.windows.network;
        self.sum(network);
        for group in &mut self.windows.groups {
            match network.shape.cell {
                Cell::Rnn => group.answer_less_bias(network, self.inputs.len()),
                Cell::Lstm => group.answer_by_gates(),
            }
        }
    }
}

impl Step<'_, '_> {
    /// Evaluates the neurons of every block; the contribution of the inputs is the same for all
    /// cells.
    #[inline(always)]
    fn sum(&mut self, network: &Recurrent) {
        let (Shape { cell, width, .. }, (numbers, _)) = (network.shape, network.parts());
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
                    cell.answers(block, &mut sums);
                    group.blocks[block * width + neuron] = sums;
                }
            }
        }
    }
}

impl Group {
    /// Group of cells with an empty memory.
    fn empty(network: &Recurrent) -> Self {
        let width = network.shape.width;
        let nothing = |count: usize| vec![[0.0; LANES]; count];
        let blocks = nothing(network.shape.cell.blocks() * width);
        Self { answers: nothing(width), kept: nothing(width), blocks }
    }

    /// Resets the memory of a cell.
    fn forget(&mut self, lane: usize) {
        self.answers.iter_mut().chain(&mut self.kept).for_each(|lanes| lanes[lane] = 0.0);
    }

    /// Outputs of simple recurrent cells: the output at zero input is subtracted.
    #[inline(always)]
    fn answer_less_bias(&mut self, network: &Recurrent, inputs: usize) {
        let (cell, _) = network.parts();
        let row = inputs + network.shape.width + 1;
        let neurons = self.answers.iter_mut().zip(&self.blocks);
        for ((answers, sums), weights) in neurons.zip(cell.chunks_exact(row)) {
            let bias = neuron(weights[row - 1]).0;
            *answers = std::array::from_fn(|lane| sums[lane] - bias);
        }
    }

    /// Outputs and memory of LSTM cells.
    #[inline(always)]
    fn answer_by_gates(&mut self) {
        let mut blocks = self.blocks.chunks_exact(self.answers.len());
        let mut next = || blocks.next().unwrap_or_default();
        // In the order of the cell's blocks.
        let [enters, stays, shown, new]: [&[Lanes]; 4] = std::array::from_fn(|_| next());
        for (k, (answers, kept)) in self.answers.iter_mut().zip(&mut self.kept).enumerate() {
            for lane in 0..LANES {
                kept[lane] = stays[k][lane] * kept[lane] + enters[k][lane] * new[k][lane];
            }
            *answers = std::array::from_fn(|lane| shown[k][lane] * neuron(kept[lane]).0);
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
        for cell in [Cell::Rnn, Cell::Lstm] {
            for memory in [Memory::Steps(1), Memory::Steps(7), Memory::All] {
                let shape = Shape { cell, memory, inputs: 5, width: 6, outputs: 3 };
                let mut network = Recurrent::drawn(shape, 3);
                network
                    .numbers
                    .iter_mut()
                    .enumerate()
                    .for_each(|(k, w)| *w += 0.01 * k as f64 % 0.1);
                let mut windows = Windows::new(&network);
                for k in 0..inputs.len() {
                    let seen = inputs[network.sees_from(k)..=k].iter().map(Vec::as_slice);
                    assert_eq!(
                        windows.step(&inputs[k]),
                        network.unrolled(seen).outputs,
                        "{shape:?}"
                    );
                }
            }
        }
    }
}
