//! Training by Adam on squared errors, with early stopping on validation examples.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::error::HorizonError;
use super::example::TrackExample;
use super::predictor::TrackPredictor;
use super::scaling::ColumnScaling;
use crate::draws::RandomStream;
use crate::recurrent::{
    AdamOptimizer, NetworkMemory, NetworkShape, RecurrentCell, RecurrentNetwork,
};
use crate::setting_error::SettingError;

/// Settings of the training of a predictor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonTraining {
    /// Kind of cell; an RNN with a memory of one sample is a perceptron of three hidden layers.
    pub cell: RecurrentCell,
    /// Number of neurons of each layer.
    pub width: usize,
    /// Largest number of epochs.
    pub epochs: usize,
    /// Number of epochs without improvement after which the training ends (Kanazawa 2023 has 200).
    pub patience: usize,
    /// Number of examples per step.
    pub batch: usize,
    /// Learning rate of Adam.
    pub rate: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl HorizonTraining {
    /// Checks the settings.
    ///
    /// # Errors
    /// Returns the first setting that is out of range, with the permitted range.
    pub fn check_settings(&self) -> Result<(), SettingError> {
        SettingError::check_width(self.width)?;
        SettingError::check_epochs(self.epochs)?;
        SettingError::check_batch(self.batch)?;
        SettingError::check_rate(self.rate)
    }
}

/// Smallest number of examples.
const FEWEST: usize = 20;

/// Example with scaled inputs and target.
struct ScaledExample {
    inputs: Vec<Vec<f64>>,
    target: Vec<f64>,
}

/// Trains a predictor of the foundation's error. It continues from `start` if given, with its
/// scaling (pre-training: Kanazawa 2023, sec. 3.3.1). The same arguments give the same bytes.
///
/// # Errors
/// Returns an error if a setting is out of range, if there are too few examples, or if their sizes
/// do not match.
pub fn train_predictor(
    seen: &[TrackExample],
    kept: &[TrackExample],
    training: &HorizonTraining,
    start: Option<&TrackPredictor>,
) -> Result<TrackPredictor, HorizonError> {
    training.check_settings()?;
    if seen.len() < FEWEST || kept.is_empty() {
        return Err(HorizonError::Few { found: seen.len().min(kept.len()), wanted: FEWEST });
    }
    let first = start.cloned().unwrap_or_else(|| random_predictor(seen, training));
    check_sizes(seen, &first)?;
    check_sizes(kept, &first)?;
    let (seen, kept) = (scale_examples(seen, &first), scale_examples(kept, &first));
    Ok(minimize_error(first, &seen, &kept, training))
}

/// Predictor with random weights, and the scaling of the training examples.
fn random_predictor(seen: &[TrackExample], training: &HorizonTraining) -> TrackPredictor {
    let rows: Vec<&[f64]> = seen.iter().flat_map(|one| &one.inputs).map(Vec::as_slice).collect();
    // Targets are errors of the foundation, not positions.
    let targets: Vec<Vec<f64>> = seen.iter().map(TrackExample::foundation_error).collect();
    let targets: Vec<&[f64]> = targets.iter().map(Vec::as_slice).collect();
    let (inputs, answers) = (ColumnScaling::from_rows(&rows), ColumnScaling::from_rows(&targets));
    let shape = NetworkShape {
        cell: training.cell,
        memory: NetworkMemory::All,
        inputs: inputs.width(),
        width: training.width,
        outputs: answers.width(),
    };
    let network = RecurrentNetwork::with_random_weights(shape, training.seed);
    TrackPredictor { network, inputs, answers, spread_m: Vec::new(), validation: Vec::new() }
}

/// Checks that the examples fit the predictor.
fn check_sizes(examples: &[TrackExample], predictor: &TrackPredictor) -> Result<(), HorizonError> {
    let (inputs, answers) = (predictor.inputs.width(), predictor.answers.width());
    let wrong = |one: &TrackExample| {
        let row = one.inputs.iter().map(Vec::len).find(|found| *found != inputs);
        let row = row.map(|found| HorizonError::Shape { found, wanted: inputs });
        let found = one.sailed.len();
        row.or((found != answers).then_some(HorizonError::Shape { found, wanted: answers }))
    };
    examples.iter().find_map(wrong).map_or(Ok(()), Err)
}

fn scale_examples(examples: &[TrackExample], predictor: &TrackPredictor) -> Vec<ScaledExample> {
    let of = |one: &TrackExample| ScaledExample {
        inputs: one.inputs.iter().map(|row| predictor.inputs.scale_row(row)).collect(),
        target: predictor.answers.scale_row(&one.foundation_error()),
    };
    examples.iter().map(of).collect()
}

/// Minimises the mean squared error, and keeps the network of least validation error.
fn minimize_error(
    mut predictor: TrackPredictor,
    seen: &[ScaledExample],
    kept: &[ScaledExample],
    training: &HorizonTraining,
) -> TrackPredictor {
    let mut adam = AdamOptimizer::new(predictor.network.numbers.len());
    let mut draws = RandomStream::new(training.seed, 1);
    let mut network = predictor.network.clone();
    // The starting network counts as the best so far, so pre-training is never made worse.
    let (mut best, mut last_gain) = (mean_square(&network, kept), 0);
    for epoch in 1..=training.epochs {
        for batch in draws.sample_indices(seen.len(), seen.len()).chunks(training.batch) {
            let gradient = batch_gradient(&network, seen, batch);
            adam.apply_gradient(&mut network.numbers, &gradient, training.rate);
        }
        let loss = mean_square(&network, kept);
        predictor.validation.push(loss);
        // Early stopping: the best network on the validation examples is kept.
        if loss < best {
            (best, last_gain) = (loss, epoch);
            predictor.network = network.clone();
        } else if epoch - last_gain >= training.patience {
            break;
        }
    }
    predictor.spread_m = validation_rms(&predictor, kept);
    predictor
}

/// Number of examples whose gradients are summed by one thread.
const CHUNK: usize = 8;

/// Gradient of the mean squared error of a batch. Fixed parts are summed in a fixed order, so the
/// result does not depend on the threads.
fn batch_gradient(network: &RecurrentNetwork, seen: &[ScaledExample], batch: &[u32]) -> Vec<f64> {
    let share = 2.0 / (batch.len() * network.shape.outputs) as f64;
    let part = |part: &[u32]| {
        let mut gradient = vec![0.0; network.numbers.len()];
        for k in part {
            let ScaledExample { inputs, target } = &seen[*k as usize];
            let unrolled = network.unroll_steps(inputs.iter().map(Vec::as_slice));
            // Derivative of the mean over examples and outputs.
            let off = unrolled.outputs.iter().zip(target);
            let blame: Vec<f64> = off.map(|(answer, target)| share * (answer - target)).collect();
            network.propagate_back(&unrolled, &blame, &mut gradient);
        }
        gradient
    };
    let each: Vec<Vec<f64>> = batch.par_chunks(CHUNK).map(part).collect();
    let mut sum = vec![0.0; network.numbers.len()];
    for own in &each {
        sum.iter_mut().zip(own).for_each(|(sum, slope)| *sum += slope);
    }
    sum
}

/// Mean squared error of each output over the examples, scaled.
fn squared_errors(network: &RecurrentNetwork, examples: &[ScaledExample]) -> Vec<f64> {
    let one = |ScaledExample { inputs, target }: &ScaledExample| -> Vec<f64> {
        let outputs = network.unroll_steps(inputs.iter().map(Vec::as_slice)).outputs;
        outputs.iter().zip(target).map(|(answer, target)| (answer - target).powi(2)).collect()
    };
    let each: Vec<Vec<f64>> = examples.par_iter().map(one).collect();
    let mut sums = vec![0.0; network.shape.outputs];
    for own in &each {
        sums.iter_mut().zip(own).for_each(|(sum, square)| *sum += square / each.len() as f64);
    }
    sums
}

fn mean_square(network: &RecurrentNetwork, examples: &[ScaledExample]) -> f64 {
    squared_errors(network, examples).iter().sum::<f64>() / network.shape.outputs as f64
}

/// Root mean squared error of each output, m.
fn validation_rms(predictor: &TrackPredictor, kept: &[ScaledExample]) -> Vec<f64> {
    let squares = squared_errors(&predictor.network, kept);
    let scales = predictor.answers.scales();
    squares.iter().zip(scales).map(|(square, scale)| scale * square.sqrt()).collect()
}
