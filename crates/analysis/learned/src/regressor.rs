//! What was learned of one acceleration, of any kind.

use serde::{Deserialize, Serialize};
use sistership_model::branch::Learner;

use crate::boosted::{self, BoostedTrees, Boosting};
use crate::draws::Draws;
use crate::forest;
use crate::kernels::{self, Kernels};
use crate::perceptron::{self, Descent, Perceptron};
use crate::sample::Sample;
use crate::tree::{Growth, Tree};

/// Weights of one output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Regressor {
    /// The mean of trees.
    RandomForest(Vec<Tree>),
    /// The sum of trees.
    BoostedTrees(BoostedTrees),
    /// The sum of kernels.
    KernelRidge(Kernels),
    /// A network.
    Perceptron(Perceptron),
}

/// Half width of the secants that stand for the derivatives of trees, whose own are zero or
/// infinite, in deviations of the input over the training. Wider secants miss the curvature of what
/// was learned, narrower ones show single leaves; the test below has the errors at half and double.
const HALF_SECANT: f64 = 0.5;

/// Streams of random numbers between the outputs: more than the trees that one may have.
const STREAMS: u64 = 1 << 16;

impl Regressor {
    /// Learns one output; none where its equations are singular.
    pub fn train(learner: &Learner, sample: &Sample, seed: u64, output: usize) -> Option<Self> {
        let stream = STREAMS * output as u64;
        let mut draws = Draws::new(seed, stream);
        Some(match *learner {
            Learner::RandomForest { trees, tried, leaf, depth } => {
                let growth = Growth { leaf, depth, tried };
                Self::RandomForest(forest::train(sample, trees, growth, seed, stream))
            }
            Learner::BoostedTrees { trees, leaf, depth, rate, sampled } => {
                let growth = Growth { leaf, depth, tried: sample.columns.len() };
                let boosting = Boosting { trees, rate, sampled };
                Self::BoostedTrees(boosted::train(sample, boosting, growth, seed, stream))
            }
            Learner::KernelRidge { centres, length, ridge } => {
                Self::KernelRidge(kernels::train(sample, centres, length, ridge, &mut draws)?)
            }
            Learner::Perceptron { ref hidden, epochs, batch, rate, decay } => {
                let descent = Descent { hidden, epochs, batch, rate, decay };
                Self::Perceptron(perceptron::train(sample, &descent, &mut draws))
            }
        })
    }

    /// The answer, in deviations, to inputs in deviations.
    #[inline]
    pub fn answer(&self, inputs: &[f64]) -> f64 {
        match self {
            Self::RandomForest(trees) => forest::answer(trees, inputs),
            Self::BoostedTrees(boosted) => boosted.answer(inputs),
            Self::KernelRidge(kernels) => kernels.answer(inputs),
            Self::Perceptron(network) => network.answer(inputs),
        }
    }

    /// The derivatives of the answer with the inputs, both in deviations: analytic where the answer
    /// is smooth, else secants over [`HALF_SECANT`] to either side.
    pub fn gradient(&self, inputs: &[f64]) -> Vec<f64> {
        let mut slopes = vec![0.0; inputs.len()];
        match self {
            Self::KernelRidge(kernels) => kernels.add_gradient(inputs, &mut slopes),
            Self::Perceptron(network) => network.add_gradient(inputs, &mut slopes),
            Self::RandomForest(_) | Self::BoostedTrees(_) => {
                let mut moved = inputs.to_vec();
                for (place, slope) in slopes.iter_mut().enumerate() {
                    *slope = self.secant(&mut moved, place, HALF_SECANT);
                }
            }
        }
        slopes
    }

    /// The mean slope about the place of an input; `inputs` are as before afterwards.
    fn secant(&self, inputs: &mut [f64], place: usize, half: f64) -> f64 {
        let centre = inputs[place];
        let [above, below] = [1.0, -1.0].map(|side| {
            inputs[place] = centre + side * half;
            self.answer(inputs)
        });
        inputs[place] = centre;
        (above - below) / (2.0 * half)
    }

    /// Whether it is of a learner's kind.
    pub fn is_of(&self, learner: &Learner) -> bool {
        matches!(
            (self, learner),
            (Self::RandomForest(_), Learner::RandomForest { .. })
                | (Self::BoostedTrees(_), Learner::BoostedTrees { .. })
                | (Self::KernelRidge(_), Learner::KernelRidge { .. })
                | (Self::Perceptron(_), Learner::Perceptron { .. })
        )
    }

    /// Whether its parts go together for so many inputs.
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
    fn sample(count: usize) -> Sample {
        let mut draws = Draws::new(5, 0);
        let mut normal = || (0..12).map(|_| 0.5 * draws.signed()).sum::<f64>();
        let columns = [0, 1].map(|_| (0..count).map(|_| normal()).collect::<Vec<f64>>());
        let truth = |k: usize| (1.5 * columns[0][k]).sin() + 0.5 * columns[1][k];
        let targets = (0..count).map(|k| truth(k) + 0.4 * normal()).collect();
        Sample { columns: columns.to_vec(), targets }
    }

    /// Root mean square error of secants of the first input, over points of the training.
    fn error(regressor: &Regressor, sample: &Sample, half: f64) -> f64 {
        let of = |k: usize| {
            let mut row = sample.row(k);
            let truth = 1.5 * (1.5 * row[0]).cos();
            (regressor.secant(&mut row, 0, half) - truth).powi(2)
        };
        let places = (0..sample.len()).step_by(7).collect::<Vec<usize>>();
        (places.iter().map(|k| of(*k)).sum::<f64>() / places.len() as f64).sqrt()
    }

    #[test]
    fn secants_of_half_a_deviation_are_nearest_to_the_slopes_that_trees_learned() {
        let sample = sample(2400);
        for kind in [BranchKind::Forest, BranchKind::Boosted] {
            let regressor = Regressor::train(&kind.learner(), &sample, 1, 0).unwrap();
            let errors =
                [0.25, 0.5, 1.0, 2.0].map(|by| error(&regressor, &sample, by * HALF_SECANT));
            println!("{}: {errors:.3?} at 1/4, 1/2, 1 and 2 of it", kind.name());
            assert!(errors[2] < errors[0] && errors[2] < errors[3], "{errors:?}");
        }
    }
}
