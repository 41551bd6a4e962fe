//! Regressor of one acceleration, of any kind of learner.

use serde::{Deserialize, Serialize};
use sistership_model::branch::Learner;

use crate::boosted::{self, BoostedTrees, BoostingSettings};
use crate::draws::RandomStream;
use crate::forest;
use crate::kernels::{self, KernelSum};
use crate::perceptron::{self, DescentSettings, Perceptron};
use crate::sample::TrainingSample;
use crate::tree::{GrowthSettings, RegressionTree};

/// Trained weights of one output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutputRegressor {
    /// Mean of trees.
    RandomForest(Vec<RegressionTree>),
    /// Sum of trees.
    BoostedTrees(BoostedTrees),
    /// Sum of kernels.
    KernelRidge(KernelSum),
    /// Neural network.
    Perceptron(Perceptron),
}

/// Half width of the secants that replace the derivatives of trees, which are zero or infinite, in
/// standard deviations of the input over the training data. Wider secants miss the curvature of the
/// learned function, narrower ones show single leaves; the test below has the errors at half and
/// double.
const HALF_SECANT: f64 = 0.5;

/// Distance between the random number streams of two outputs: more than the largest number of
/// trees.
const STREAMS: u64 = 1 << 16;

impl OutputRegressor {
    /// Trains the regressor of one output. Returns `None` if its equations are singular.
    pub fn train_output(
        learner: &Learner,
        sample: &TrainingSample,
        seed: u64,
        output: usize,
    ) -> Option<Self> {
        let stream = STREAMS * output as u64;
        let mut draws = RandomStream::new(seed, stream);
        Some(match *learner {
            // Trees draw from streams of their own, counted from the output's first stream.
            Learner::RandomForest { trees, tried, leaf, depth } => {
                let growth = GrowthSettings { leaf, depth, tried };
                Self::RandomForest(forest::train_forest(sample, trees, growth, seed, stream))
            }
            Learner::BoostedTrees { trees, leaf, depth, rate, sampled } => {
                // Boosted trees consider all inputs at each split.
                let growth = GrowthSettings { leaf, depth, tried: sample.columns.len() };
                let boosting = BoostingSettings { trees, rate, sampled };
                Self::BoostedTrees(boosted::train_boosted(sample, boosting, growth, seed, stream))
            }
            Learner::KernelRidge { centres, length, ridge } => Self::KernelRidge(
                kernels::train_kernels(sample, centres, length, ridge, &mut draws)?,
            ),
            Learner::Perceptron { ref hidden, epochs, batch, rate, decay } => {
                let descent = DescentSettings { hidden, epochs, batch, rate, decay };
                Self::Perceptron(perceptron::train_perceptron(sample, &descent, &mut draws))
            }
        })
    }

    /// Prediction for scaled inputs, in standard deviations of the target.
    #[inline]
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        match self {
            Self::RandomForest(trees) => forest::predict_mean(trees, inputs),
            Self::BoostedTrees(boosted) => boosted.predict(inputs),
            Self::KernelRidge(kernels) => kernels.predict(inputs),
            Self::Perceptron(network) => network.predict(inputs),
        }
    }

    /// Derivatives of the prediction with respect to the inputs, both in standard deviations:
    /// analytic where the regressor is smooth, otherwise secants over [`HALF_SECANT`] to either
    /// side.
    pub fn input_gradient(&self, inputs: &[f64]) -> Vec<f64> {
        let mut slopes = vec![0.0; inputs.len()];
        match self {
            Self::KernelRidge(kernels) => kernels.add_gradient(inputs, &mut slopes),
            Self::Perceptron(network) => network.add_gradient(inputs, &mut slopes),
            Self::RandomForest(_) | Self::BoostedTrees(_) => {
                // One copy is enough: each secant restores the input that it moves.
                let mut moved = inputs.to_vec();
                for (place, slope) in slopes.iter_mut().enumerate() {
                    *slope = self.central_secant(&mut moved, place, HALF_SECANT);
                }
            }
        }
        slopes
    }

    /// Slope of the secant through two points about one input; `inputs` are restored afterwards.
    fn central_secant(&self, inputs: &mut [f64], place: usize, half: f64) -> f64 {
        let centre = inputs[place];
        let [above, below] = [1.0, -1.0].map(|side| {
            inputs[place] = centre + side * half;
            self.predict(inputs)
        });
        inputs[place] = centre;
        (above - below) / (2.0 * half)
    }

    /// True if the regressor is of the kind of the learner.
    pub fn matches_learner(&self, learner: &Learner) -> bool {
        matches!(
            (self, learner),
            (Self::RandomForest(_), Learner::RandomForest { .. })
                | (Self::BoostedTrees(_), Learner::BoostedTrees { .. })
                | (Self::KernelRidge(_), Learner::KernelRidge { .. })
                | (Self::Perceptron(_), Learner::Perceptron { .. })
        )
    }

    /// True if the parts are consistent with each other for this number of inputs.
    pub fn is_sound(&self, inputs: usize) -> bool {
        match self {
            Self::RandomForest(trees) => {
                !trees.is_empty() && trees.iter().all(|tree| tree.is_sound(inputs))
            }
            Self::BoostedTrees(boosted) => {
                boosted.first.is_finite() && boosted.trees.iter().all(|tree| tree.is_sound(inputs))
            }
            Self::KernelRidge(kernels) => kernels.is_sound(inputs),
            Self::Perceptron(network) => network.is_sound(inputs),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::settings::BranchKind;

    /// Smooth in the first input, straight in the second, with as much noise as half of that.
    fn sample(count: usize) -> TrainingSample {
        let mut draws = RandomStream::new(5, 0);
        let mut normal = || (0..12).map(|_| 0.5 * draws.signed_unit()).sum::<f64>();
        let columns = [0, 1].map(|_| (0..count).map(|_| normal()).collect::<Vec<f64>>());
        let truth = |k: usize| (1.5 * columns[0][k]).sin() + 0.5 * columns[1][k];
        let targets = (0..count).map(|k| truth(k) + 0.4 * normal()).collect();
        TrainingSample { columns: columns.to_vec(), targets }
    }

    /// Root mean square error of secants of the first input, over points of the training.
    fn error(regressor: &OutputRegressor, sample: &TrainingSample, half: f64) -> f64 {
        let of = |k: usize| {
            let mut row = sample.row_inputs(k);
            let truth = 1.5 * (1.5 * row[0]).cos();
            (regressor.central_secant(&mut row, 0, half) - truth).powi(2)
        };
        let places = (0..sample.len()).step_by(7).collect::<Vec<usize>>();
        (places.iter().map(|k| of(*k)).sum::<f64>() / places.len() as f64).sqrt()
    }

    #[test]
    fn secants_of_half_a_deviation_are_nearest_to_the_slopes_that_trees_learned() {
        let sample = sample(2400);
        for kind in [BranchKind::Forest, BranchKind::Boosted] {
            let regressor =
                OutputRegressor::train_output(&kind.default_learner(), &sample, 1, 0).unwrap();
            let errors =
                [0.25, 0.5, 1.0, 2.0].map(|by| error(&regressor, &sample, by * HALF_SECANT));
            println!("{}: {errors:.3?} at 1/4, 1/2, 1 and 2 of it", kind.name());
            assert!(errors[2] < errors[0] && errors[2] < errors[3], "{errors:?}");
        }
    }
}
