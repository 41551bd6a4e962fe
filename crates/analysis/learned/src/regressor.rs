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
