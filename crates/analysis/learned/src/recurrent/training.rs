//! Training on sequences of states by Adam, with the network of least validation loss as the
//! result.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::adam::AdamOptimizer;
use super::error::SequenceError;
use super::loss::SequenceLoss;
use super::motion::RecordedMotion;
use super::network::{NetworkShape, RecurrentNetwork};
use super::scales::MotionScales;
use super::sequence::SequenceTraining;
use crate::draws::RandomStream;

/// Result of a training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainedNetwork {
    /// Network of the least loss on the validation sequences.
    pub network: RecurrentNetwork,
    /// Divisors of its inputs and outputs.
    pub scales: MotionScales,
    /// Loss on the validation sequences after each epoch.
    pub validation: Vec<f64>,
}

/// One of this number of sequences is used for validation.
const VALIDATION: usize = 5;

/// Start of a sequence: index of its motion, and its first sample.
type SequenceStart = (usize, usize);

/// Trains a network.
///
/// # Errors
/// Returns the setting that is out of range, or the reason why the motions cannot be used.
pub fn train_network(
    motions: &[RecordedMotion],
    training: &SequenceTraining,
) -> Result<TrainedNetwork, SequenceError> {
    training.check_settings()?;
    let known = known_count(motions)?;
    let scales = MotionScales::from_motions(motions);
    let places = sequence_starts(motions, training);
    let part = |kept: bool| -> Vec<SequenceStart> {
        // Validation sequences are spread evenly over all motions.
        let own = places.iter().enumerate().filter(|(k, _)| (k % VALIDATION == 0) == kept);
        own.map(|(_, place)| *place).collect()
    };
    let (kept, seen) = (part(true), part(false));
    if seen.is_empty() {
        // Two sequences: one for the validation, one to train on.
        let wanted = training.steps + training.hop + 1;
        return Err(SequenceError::Few { found: places.len(), wanted });
    }
    let network = RecurrentNetwork::with_random_weights(
        NetworkShape { inputs: 3 + known, ..training.shape },
        training.seed,
    );
    Ok(TrainingState { motions, training, scales, network }.minimize_loss(&seen, &kept))
}

/// Returns the number of further inputs, which all motions have in common.
fn known_count(motions: &[RecordedMotion]) -> Result<usize, SequenceError> {
    if motions.iter().any(RecordedMotion::is_empty) {
        return Err(SequenceError::Empty);
    }
    let mut counts = motions.iter().flat_map(|motion| motion.known.iter().map(Vec::len));
    let first = counts.next().ok_or(SequenceError::Empty)?;
    if counts.all(|count| count == first) { Ok(first) } else { Err(SequenceError::Channels) }
}

/// Starts of all sequences in the motions.
fn sequence_starts(motions: &[RecordedMotion], training: &SequenceTraining) -> Vec<SequenceStart> {
    let of = |(number, motion): (usize, &RecordedMotion)| {
        let last = motion.len().saturating_sub(training.steps);
        (0..last).step_by(training.hop).map(move |start| (number, start))
    };
    motions.iter().enumerate().flat_map(of).collect()
}

/// State of the training.
struct TrainingState<'a> {
    motions: &'a [RecordedMotion],
    training: &'a SequenceTraining,
    scales: MotionScales,
    network: RecurrentNetwork,
}

impl TrainingState<'_> {
    /// Minimises the loss on `seen`, and keeps the network of least loss on `kept`.
    fn minimize_loss(mut self, seen: &[SequenceStart], kept: &[SequenceStart]) -> TrainedNetwork {
        let mut adam = AdamOptimizer::new(self.network.numbers.len());
        let mut draws = RandomStream::new(self.training.seed, 1);
        let (mut best, mut validation) = (self.network.clone(), Vec::new());
        for _ in 0..self.training.epochs {
            for batch in draws.sample_indices(seen.len(), seen.len()).chunks(self.training.batch) {
                let places: Vec<SequenceStart> = batch.iter().map(|k| seen[*k as usize]).collect();
                let (_, gradient) = self.mean_loss(&places);
                adam.apply_gradient(&mut self.network.numbers, &gradient, self.training.rate);
            }
            // Very short motions leave no validation sequence; then the training loss decides.
            let loss = self.mean_loss(if kept.is_empty() { seen } else { kept }).0;
            if validation.iter().all(|earlier| loss < *earlier) {
                best = self.network.clone();
            }
            validation.push(loss);
        }
        TrainedNetwork { network: best, scales: self.scales, validation }
    }

    /// Mean loss of some sequences, and its gradient. They are summed in a fixed order, so the
    /// result does not depend on the threads.
    fn mean_loss(&self, places: &[SequenceStart]) -> (f64, Vec<f64>) {
        let each: Vec<(f64, Vec<f64>)> =
            places.par_iter().map(|place| self.sequence_loss(*place)).collect();
        let mut gradient = vec![0.0; self.network.numbers.len()];
        let share = 1.0 / places.len() as f64;
        for (_, own) in &each {
            gradient.iter_mut().zip(own).for_each(|(sum, slope)| *sum += share * slope);
        }
        // Losses were computed in parallel, but are summed in order.
        (share * each.iter().map(|(loss, _)| loss).sum::<f64>(), gradient)
    }

    fn sequence_loss(&self, (motion, start): SequenceStart) -> (f64, Vec<f64>) {
        let Self { motions, training, ref scales, ref network } = *self;
        SequenceLoss { network, scales, training }.with_gradient(&motions[motion], start)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::cell::RecurrentCell;
    use super::super::network::NetworkMemory;
    use super::super::sequence::LossKind;
    use super::*;

    /// A motion with a rudder that swings.
    fn motion() -> RecordedMotion {
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
        RecordedMotion {
            interval_s: 0.1,
            positions,
            velocities: (0..200).map(velocities).collect(),
            known: (0..200).map(|k| vec![(0.9 * at(k)).sin(), 8.0]).collect(),
            given: (0..200).map(|k| [0.01, -0.01 * (0.9 * at(k)).sin(), 0.0]).collect(),
        }
    }

    fn training(cell: RecurrentCell, memory: NetworkMemory, loss: LossKind) -> SequenceTraining {
        let shape = NetworkShape { cell, memory, inputs: 5, width: 4, outputs: 3 };
        let (steps, hop, epochs, batch) = (12, 5, 60, 4);
        SequenceTraining { shape, loss, steps, hop, epochs, batch, rate: 0.01, seed: 3 }
    }

    fn all() -> impl Iterator<Item = SequenceTraining> {
        let memories = [NetworkMemory::Steps(3), NetworkMemory::All];
        let losses = [LossKind::States, LossKind::Accelerations];
        [RecurrentCell::Rnn, RecurrentCell::Lstm].into_iter().flat_map(move |cell| {
            memories.into_iter().flat_map(move |memory| {
                losses.into_iter().map(move |loss| training(cell, memory, loss))
            })
        })
    }

    #[test]
    fn gradients_are_those_of_differences() {
        let motions = [motion()];
        for training in all() {
            let mut network = RecurrentNetwork::with_random_weights(training.shape, 5);
            // Biases that are not nothing.
            let numbers = network.numbers.iter_mut().enumerate();
            numbers.for_each(|(k, number)| *number += 0.02 * ((k % 7) as f64 - 3.0));
            let scales = MotionScales::from_motions(&motions);
            let mut trainee =
                TrainingState { motions: &motions, training: &training, scales, network };
            let (_, gradient) = trainee.sequence_loss((0, 4));
            for k in (0..gradient.len()).step_by(5) {
                let mut loss_at = |by: f64| {
                    let kept = trainee.network.numbers[k];
                    trainee.network.numbers[k] = kept + by;
                    let loss = trainee.sequence_loss((0, 4)).0;
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
            let first = train_network(&motions, &training).unwrap();
            let (start, best) =
                (first.validation[0], first.validation.iter().copied().fold(f64::MAX, f64::min));
            assert!(best < 0.7 * start, "{training:?}: {start} {best}");
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            assert_eq!(pool.install(|| train_network(&motions, &training)).unwrap(), first);
        }
    }

    #[test]
    fn settings_and_motions_that_cannot_be_used_are_refused() {
        let good = training(RecurrentCell::Rnn, NetworkMemory::Steps(3), LossKind::States);
        let refusal = |motions: &[RecordedMotion], training: &SequenceTraining| {
            train_network(motions, training).unwrap_err()
        };
        let without_batch = SequenceTraining { batch: 0, ..good.clone() };
        let refused = refusal(&[motion()], &without_batch);
        assert_eq!(refused.to_string(), "batch: should be from 1 to 65536");
        let empty = RecordedMotion {
            positions: Vec::new(),
            velocities: Vec::new(),
            known: Vec::new(),
            given: Vec::new(),
            ..motion()
        };
        assert_eq!(refusal(&[motion(), empty], &good), SequenceError::Empty);
        let mut other = motion();
        other.known.iter_mut().for_each(|known| known.truncate(1));
        assert_eq!(refusal(&[motion(), other], &good), SequenceError::Channels);
        let long = SequenceTraining { steps: 198, ..good };
        assert_eq!(refusal(&[motion()], &long), SequenceError::Few { found: 1, wanted: 204 });
    }

    #[test]
    fn an_rnn_makes_nothing_of_nothing() {
        let shape = training(RecurrentCell::Rnn, NetworkMemory::Steps(3), LossKind::States).shape;
        let mut network = RecurrentNetwork::with_random_weights(shape, 1);
        network.numbers.iter_mut().for_each(|number| *number += 0.3);
        let nothing = [0.0; 5];
        let outputs = network.unroll_steps([&nothing[..]; 3].into_iter()).outputs;
        assert!(outputs.iter().all(|output| output.abs() < 1e-15), "{outputs:?}");
    }
}
