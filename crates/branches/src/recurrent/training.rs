//! Training on sequences of states: the loss is on positions and velocities that the network
//! simulates (Wakita 2022, Eq. 24), or on accelerations (Eq. 17).

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::motion::Motion;
use super::network::{Memory, Recurrent, Shape, Unrolled};
use crate::draws::Draws;
use crate::sample::centre_and_scale;

/// What is to be small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// What simulated positions and velocities lack of the recorded ones: Eq. 24.
    States,
    /// What accelerations lack of differences of the recorded velocities: Eq. 17.
    Accelerations,
}

/// How a network is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceTraining {
    /// The network; its inputs follow from the motions.
    pub shape: Shape,
    /// What is to be small.
    pub loss: Loss,
    /// Samples of a sequence, of which those that fill the memory are given: Table 8's N_T.
    pub steps: usize,
    /// Samples from the start of a sequence to that of the next.
    pub hop: usize,
    /// How often every sequence is seen.
    pub epochs: usize,
    /// Sequences to a step.
    pub batch: usize,
    /// Length of the steps of Adam.
    pub rate: f64,
    /// Of every random number drawn.
    pub seed: u64,
}

/// Deviations by which inputs, outputs and states are divided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// Of x, y, psi.
    pub positions: [f64; 3],
    /// Of u, v, r.
    pub velocities: [f64; 3],
    /// Of what is known beside.
    pub known: Vec<f64>,
    /// Of the accelerations, by differences.
    pub accelerations: [f64; 3],
}

/// A network that was trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// The network, of the least loss on the sequences kept for validation.
    pub network: Recurrent,
    /// What its inputs and outputs are divided by.
    pub scales: Scales,
    /// Loss on the sequences kept for validation, after each epoch.
    pub validation: Vec<f64>,
}

/// Of so many sequences one is kept for validation.
const VALIDATION: usize = 5;

/// Where a sequence is: its motion, and its first sample.
type Place = (usize, usize);

impl Scales {
    /// Of some motions.
    pub fn of(motions: &[Motion]) -> Self {
        let scale = |of: &dyn Fn(&Motion) -> Vec<f64>| {
            centre_and_scale(&motions.iter().flat_map(of).collect::<Vec<f64>>()).1
        };
        let three = |of: &dyn Fn(&Motion, usize, usize) -> f64, less: usize| {
            let axis = |axis: usize| {
                let column = |motion: &Motion| {
                    (0..motion.len() - less).map(|k| of(motion, k, axis)).collect()
                };
                scale(&column)
            };
            std::array::from_fn(axis)
        };
        let known = motions.first().map_or(0, |motion| motion.known[0].len());
        Self {
            positions: three(&|motion, k, axis| motion.positions[k][axis], 0),
            velocities: three(&|motion, k, axis| motion.velocities[k][axis], 0),
            known: (0..known)
                .map(|at| scale(&|motion| motion.known.iter().map(|known| known[at]).collect()))
                .collect(),
            accelerations: three(&|motion, k, axis| motion.differences(k)[axis], 1),
        }
    }

    /// The inputs of a step. They are not centred: of nothing comes nothing.
    pub fn inputs(&self, velocities: &[f64; 3], known: &[f64]) -> Vec<f64> {
        let own = velocities.iter().zip(&self.velocities);
        own.chain(known.iter().zip(&self.known)).map(|(value, scale)| value / scale).collect()
    }
}

/// Trains a network; none where the motions have too few samples, or not the same channels.
pub fn fit(motions: &[Motion], training: &SequenceTraining) -> Option<Fit> {
    let known = motions.first()?.known.first()?.len();
    if motions.iter().any(|motion| motion.known.iter().any(|there| there.len() != known)) {
        return None;
    }
    let scales = Scales::of(motions);
    let places = places(motions, training);
    let part = |kept: bool| -> Vec<Place> {
        let own = places.iter().enumerate().filter(|(k, _)| (k % VALIDATION == 0) == kept);
        own.map(|(_, place)| *place).collect()
    };
    let (kept, seen) = (part(true), part(false));
    if seen.is_empty() {
        return None;
    }
    let network = Recurrent::drawn(Shape { inputs: 3 + known, ..training.shape }, training.seed);
    Some(Trainee { motions, training, scales, network }.descend(&seen, &kept))
}

impl Fit {
    /// Simulates from a sample to another by Euler's method, the first `given` samples as recorded:
    /// positions and velocities at each. `foundation` gives the accelerations of a foundation at a
    /// sample and simulated velocities, m/s2, m/s2, rad/s2.
    pub fn sail(
        &self,
        motion: &Motion,
        own: std::ops::Range<usize>,
        given: usize,
        foundation: &mut dyn FnMut(usize, &[f64; 3]) -> [f64; 3],
    ) -> Vec<([f64; 3], [f64; 3])> {
        let mut run = Simulated::begin(motion, own.start, given.clamp(1, own.len()));
        let (mut inputs, mut state) = (Vec::with_capacity(own.len()), self.network.empty());
        for (step, k) in own.clone().enumerate() {
            let velocities = run.velocities[step];
            inputs.push(self.scales.inputs(&velocities, &motion.known[k]));
            let outputs = match self.network.shape.memory {
                Memory::All => self.network.step(&inputs[step], &mut state),
                Memory::Steps(_) => {
                    let seen = &inputs[self.network.sees_from(step)..];
                    self.network.unrolled(seen.iter().map(Vec::as_slice)).outputs
                }
            };
            if step + 1 >= run.velocities.len() && k + 1 < own.end {
                let law = foundation(k, &velocities);
                let scales = &self.scales.accelerations;
                let sum = std::array::from_fn(|axis| outputs[axis] * scales[axis] + law[axis]);
                run.advance(&sum, motion.interval_s);
            }
        }
        run.positions.into_iter().zip(run.velocities).collect()
    }
}

fn places(motions: &[Motion], training: &SequenceTraining) -> Vec<Place> {
    let of = |(number, motion): (usize, &Motion)| {
        let last = (motion.len() + 1).saturating_sub(training.steps + 1);
        (0..last).step_by(training.hop.max(1)).map(move |start| (number, start))
    };
    motions.iter().enumerate().flat_map(of).collect()
}

struct Trainee<'a> {
    motions: &'a [Motion],
    training: &'a SequenceTraining,
    scales: Scales,
    network: Recurrent,
}

impl Trainee<'_> {
    fn descend(mut self, seen: &[Place], kept: &[Place]) -> Fit {
        let mut adam = Adam::new(self.network.numbers.len());
        let mut draws = Draws::new(self.training.seed, 1);
        let (mut best, mut validation) = (self.network.clone(), Vec::new());
        for _ in 0..self.training.epochs {
            for batch in draws.some_of(seen.len(), seen.len()).chunks(self.training.batch) {
                let places: Vec<Place> = batch.iter().map(|k| seen[*k as usize]).collect();
                let (_, gradient) = self.sum(&places);
                adam.step(&mut self.network.numbers, &gradient, self.training.rate);
            }
            let loss = self.sum(if kept.is_empty() { seen } else { kept }).0;
            if validation.iter().all(|earlier| loss < *earlier) {
                best = self.network.clone();
            }
            validation.push(loss);
        }
        Fit { network: best, scales: self.scales, validation }
    }

    /// Mean loss of some sequences, and its gradient. They are summed in their order, whoever was
    /// first.
    fn sum(&self, places: &[Place]) -> (f64, Vec<f64>) {
        let each: Vec<(f64, Vec<f64>)> = places.par_iter().map(|place| self.one(*place)).collect();
        let mut gradient = vec![0.0; self.network.numbers.len()];
        let share = 1.0 / places.len() as f64;
        for (_, own) in &each {
            gradient.iter_mut().zip(own).for_each(|(sum, slope)| *sum += share * slope);
        }
        (share * each.iter().map(|(loss, _)| loss).sum::<f64>(), gradient)
    }

    fn one(&self, (motion, start): Place) -> (f64, Vec<f64>) {
        let motion = &self.motions[motion];
        match self.training.loss {
            Loss::States => self.states(motion, start),
            Loss::Accelerations => self.accelerations(motion, start),
        }
    }

    /// Steps that are given, so that the memory is filled: Eq. 20.
    fn given(&self) -> usize {
        match self.network.shape.memory {
            Memory::Steps(steps) => steps,
            Memory::All => 1,
        }
    }

    fn unrolled(&self, inputs: &[Vec<f64>], step: usize) -> Unrolled {
        let from = self.network.sees_from(step);
        self.network.unrolled(inputs[from..=step].iter().map(Vec::as_slice))
    }

    /// Eq. 17.
    fn accelerations(&self, motion: &Motion, start: usize) -> (f64, Vec<f64>) {
        let steps = self.training.steps;
        let inputs: Vec<Vec<f64>> = (start..start + steps)
            .map(|k| self.scales.inputs(&motion.velocities[k], &motion.known[k]))
            .collect();
        let mut gradient = vec![0.0; self.network.numbers.len()];
        let mut loss = 0.0;
        for step in self.given() - 1..steps {
            let unrolled = self.unrolled(&inputs, step);
            let measured = motion.differences(start + step);
            let blame: Vec<f64> = (0..3)
                .map(|axis| {
                    unrolled.outputs[axis] - measured[axis] / self.scales.accelerations[axis]
                })
                .collect();
            loss += blame.iter().map(|x| x * x).sum::<f64>() / steps as f64;
            let blame: Vec<f64> = blame.iter().map(|x| 2.0 * x / steps as f64).collect();
            self.network.back(&unrolled, &blame, &mut gradient);
        }
        (loss, gradient)
    }

    /// Eq. 24 by Euler's method, and its gradient back through the simulation.
    fn states(&self, motion: &Motion, start: usize) -> (f64, Vec<f64>) {
        let (steps, dt) = (self.training.steps, motion.interval_s);
        let mut run = Simulated::begin(motion, start, self.given());
        let mut inputs: Vec<Vec<f64>> = Vec::with_capacity(steps);
        let mut unrolled: Vec<Option<Unrolled>> = Vec::with_capacity(steps);
        for step in 0..steps {
            inputs.push(self.scales.inputs(&run.velocities[step], &motion.known[start + step]));
            if step + 1 < self.given() {
                unrolled.push(None);
                continue;
            }
            let one = self.unrolled(&inputs, step);
            let own = |axis: usize| one.outputs[axis] * self.scales.accelerations[axis];
            let acceleration =
                std::array::from_fn(|axis| own(axis) + motion.given[start + step][axis]);
            run.advance(&acceleration, dt);
            unrolled.push(Some(one));
        }
        let share = 1.0 / (steps - self.given() + 1) as f64;
        let mut blame = Blame::of(&run, motion, start, &self.scales, share);
        let mut gradient = vec![0.0; self.network.numbers.len()];
        for step in (self.given() - 1..steps).rev() {
            blame.through_positions(&run, step, dt);
            let outputs: Vec<f64> = (0..3)
                .map(|axis| dt * blame.velocities[step + 1][axis] * self.scales.accelerations[axis])
                .collect();
            let Some(one) = &unrolled[step] else { continue };
            let from = self.network.sees_from(step);
            for (back, seen) in self.network.back(one, &outputs, &mut gradient).iter().enumerate() {
                let at = &mut blame.velocities[from + back];
                let scaled = seen.iter().zip(&self.scales.velocities);
                at.iter_mut().zip(scaled).for_each(|(at, (seen, scale))| *at += seen / scale);
            }
        }
        (blame.loss, gradient)
    }
}

/// A simulation of a sequence, sample by sample.
struct Simulated {
    positions: Vec<[f64; 3]>,
    velocities: Vec<[f64; 3]>,
}

impl Simulated {
    fn begin(motion: &Motion, start: usize, given: usize) -> Self {
        let own = start..start + given;
        Self {
            positions: motion.positions[own.clone()].to_vec(),
            velocities: motion.velocities[own].to_vec(),
        }
    }

    /// Eqs. 21 to 23.
    fn advance(&mut self, acceleration: &[f64; 3], dt: f64) {
        let last = self.velocities.len() - 1;
        let ([x, y, psi], [u, v, r]) = (self.positions[last], self.velocities[last]);
        let (sin, cos) = psi.sin_cos();
        self.positions.push([
            x + dt * (u * cos - v * sin),
            y + dt * (u * sin + v * cos),
            psi + dt * r,
        ]);
        self.velocities.push(std::array::from_fn(|axis| {
            self.velocities[last][axis] + dt * acceleration[axis]
        }));
    }
}

/// How the loss changes with each state.
struct Blame {
    loss: f64,
    positions: Vec<[f64; 3]>,
    velocities: Vec<[f64; 3]>,
}

impl Blame {
    fn of(run: &Simulated, motion: &Motion, start: usize, scales: &Scales, share: f64) -> Self {
        let mut loss = 0.0;
        let mut one = |simulated: &[f64; 3], recorded: &[f64; 3], scales: &[f64; 3]| {
            std::array::from_fn(|axis| {
                let off = (simulated[axis] - recorded[axis]) / scales[axis];
                loss += share * off * off;
                2.0 * share * off / scales[axis]
            })
        };
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        for k in 0..run.velocities.len() {
            let there = start + k;
            positions.push(one(&run.positions[k], &motion.positions[there], &scales.positions));
            velocities.push(one(&run.velocities[k], &motion.velocities[there], &scales.velocities));
        }
        Self { loss, positions, velocities }
    }

    /// What a step's state has to answer for at the next: Eqs. 21 to 23 backwards.
    fn through_positions(&mut self, run: &Simulated, step: usize, dt: f64) {
        let ([_, _, psi], [u, v, _]) = (run.positions[step], run.velocities[step]);
        let (sin, cos) = psi.sin_cos();
        let ([x, y, heading], next) = (self.positions[step + 1], self.velocities[step + 1]);
        let at = &mut self.positions[step];
        at[0] += x;
        at[1] += y;
        at[2] += heading + dt * (x * (-u * sin - v * cos) + y * (u * cos - v * sin));
        let at = &mut self.velocities[step];
        at[0] += next[0] + dt * (x * cos + y * sin);
        at[1] += next[1] + dt * (y * cos - x * sin);
        at[2] += next[2] + dt * heading;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::cell::Cell;
    use super::*;

    /// A motion with a rudder that swings.
    fn motion() -> Motion {
        let at = |k: usize| 0.1 * k as f64;
        let velocities = |k: usize| {
            let t = at(k);
            [0.5 + 0.1 * t.sin(), 0.05 * (1.3 * t).cos(), 0.04 * (0.7 * t).sin()]
        };
        // Where Euler's method leads by these velocities.
        let mut positions = vec![[0.0; 3]];
        for k in 0..199 {
            let ([x, y, psi], [u, v, r]) = (positions[k], velocities(k));
            let (sin, cos) = f64::sin_cos(psi);
            let (north, east) = (u * cos - v * sin, u * sin + v * cos);
            positions.push([x + 0.1 * north, y + 0.1 * east, psi + 0.1 * r]);
        }
        Motion {
            interval_s: 0.1,
            positions,
            velocities: (0..200).map(velocities).collect(),
            known: (0..200).map(|k| vec![(0.9 * at(k)).sin(), 8.0]).collect(),
            given: (0..200).map(|k| [0.01, -0.01 * (0.9 * at(k)).sin(), 0.0]).collect(),
        }
    }

    fn training(cell: Cell, memory: Memory, loss: Loss) -> SequenceTraining {
        let shape = Shape { cell, memory, inputs: 5, width: 4, outputs: 3 };
        let (steps, hop, epochs, batch) = (12, 5, 60, 4);
        SequenceTraining { shape, loss, steps, hop, epochs, batch, rate: 0.01, seed: 3 }
    }

    fn all() -> impl Iterator<Item = SequenceTraining> {
        let memories = [Memory::Steps(3), Memory::All];
        let losses = [Loss::States, Loss::Accelerations];
        [Cell::Rnn, Cell::Lstm].into_iter().flat_map(move |cell| {
            memories.into_iter().flat_map(move |memory| {
                losses.into_iter().map(move |loss| training(cell, memory, loss))
            })
        })
    }

    #[test]
    fn gradients_are_those_of_differences() {
        let motions = [motion()];
        for training in all() {
            let mut network = Recurrent::drawn(training.shape, 5);
            // Biases that are not nothing.
            let numbers = network.numbers.iter_mut().enumerate();
            numbers.for_each(|(k, number)| *number += 0.02 * ((k % 7) as f64 - 3.0));
            let scales = Scales::of(&motions);
            let mut trainee = Trainee { motions: &motions, training: &training, scales, network };
            let (_, gradient) = trainee.one((0, 4));
            for k in (0..gradient.len()).step_by(5) {
                let mut loss_at = |by: f64| {
                    let kept = trainee.network.numbers[k];
                    trainee.network.numbers[k] = kept + by;
                    let loss = trainee.one((0, 4)).0;
                    trainee.network.numbers[k] = kept;
                    loss
                };
                let slope = (loss_at(1e-5) - loss_at(-1e-5)) / 2e-5;
                let off = (gradient[k] - slope).abs();
                assert!(
                    off < 1e-6 * (1.0 + slope.abs()),
                    "{training:?} {k}: {} {slope}",
                    gradient[k]
                );
            }
        }
    }

    #[test]
    fn training_lowers_the_loss_and_repeats_itself() {
        let motions = [motion()];
        for training in all() {
            let first = fit(&motions, &training).unwrap();
            let (start, best) =
                (first.validation[0], first.validation.iter().copied().fold(f64::MAX, f64::min));
            assert!(best < 0.7 * start, "{training:?}: {start} {best}");
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            assert_eq!(pool.install(|| fit(&motions, &training)).unwrap(), first);
        }
    }

    #[test]
    fn an_rnn_makes_nothing_of_nothing() {
        let shape = training(Cell::Rnn, Memory::Steps(3), Loss::States).shape;
        let mut network = Recurrent::drawn(shape, 1);
        network.numbers.iter_mut().for_each(|number| *number += 0.3);
        let nothing = [0.0; 5];
        let outputs = network.unrolled([&nothing[..]; 3].into_iter()).outputs;
        assert!(outputs.iter().all(|output| output.abs() < 1e-15), "{outputs:?}");
        let mut state = network.empty();
        assert_eq!(network.step(&nothing, &mut state), outputs);
    }
}
