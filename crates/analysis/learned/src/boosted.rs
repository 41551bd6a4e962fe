//! Boosted trees on squared errors (Friedman 2002, Algorithm 1).

use serde::{Deserialize, Serialize};

use crate::draws::RandomStream;
use crate::sample::TrainingSample;
use crate::tree::{GrowthSettings, InputBins, RegressionTree, grow_tree};

/// Sum of regression trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoostedTrees {
    /// Prediction before the first tree: the mean of the targets.
    pub first: f64,
    /// Trees, whose predictions are added.
    pub trees: Vec<RegressionTree>,
}

/// Settings of boosting.
#[derive(Debug, Clone, Copy)]
pub struct BoostingSettings {
    /// Number of trees.
    pub trees: usize,
    /// Learning rate: factor of each tree's prediction.
    pub rate: f64,
    /// Share of the samples on which each tree is grown.
    pub sampled: f64,
}

/// Adds tree after tree, each grown on the residuals of those before it, on a random part of the
/// samples.
pub fn train_boosted(
    sample: &TrainingSample,
    boosting: BoostingSettings,
    growth: GrowthSettings,
    seed: u64,
    stream: u64,
) -> BoostedTrees {
    let (bins, mut draws) =
        (InputBins::from_columns(&sample.columns), RandomStream::new(seed, stream));
    let first = sample.targets.iter().sum::<f64>() / sample.len() as f64;
    // Residuals of the trees so far, which are the negative gradient of the squared error.
    let mut left: Vec<f64> = sample.targets.iter().map(|target| target - first).collect();
    let inputs: Vec<Vec<f64>> = (0..sample.len()).map(|k| sample.row_inputs(k)).collect();
    // At least one sample, however small the share is.
    let count = ((boosting.sampled * sample.len() as f64).ceil() as usize).max(1);
    let mut trees = Vec::with_capacity(boosting.trees);
    for _ in 0..boosting.trees {
        let mut rows = draws.sample_indices(count, sample.len());
        // Rows in ascending order are read from memory in sequence.
        rows.sort_unstable();
        // The tree is stored with the learning rate included, so that a prediction is a plain sum.
        let tree = grow_tree(&bins, &left, rows, growth, &mut draws).scaled_by(boosting.rate);
        left.iter_mut().zip(&inputs).for_each(|(left, inputs)| *left -= tree.predict(inputs));
        trees.push(tree);
    }
    BoostedTrees { first, trees }
}

impl BoostedTrees {
    /// Prediction: the sum over all trees.
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        self.first + self.trees.iter().map(|tree| tree.predict(inputs)).sum::<f64>()
    }
}
