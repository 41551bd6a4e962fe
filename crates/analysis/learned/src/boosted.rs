//! Boosted trees on squared errors (Friedman 2002, Algorithm 1).

use serde::{Deserialize, Serialize};

use crate::draws::Draws;
use crate::sample::Sample;
use crate::tree::{Bins, Growth, Tree, grow};

/// Sum of regression trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoostedTrees {
    /// Prediction before the first tree: the mean of the targets.
    pub first: f64,
    /// Trees, whose predictions are added.
    pub trees: Vec<Tree>,
}

/// Settings of boosting.
#[derive(Debug, Clone, Copy)]
pub struct Boosting {
    /// Number of trees.
    pub trees: usize,
    /// Learning rate: factor of each tree's prediction.
    pub rate: f64,
    /// Share of the samples on which each tree is grown.
    pub sampled: f64,
}

/// Adds tree after tree, each grown on the residuals of those before it, on a random part of the
/// samples.
pub fn train(
    sample: &Sample,
    boosting: Boosting,
    growth: Growth,
    seed: u64,
    stream: u64,
) -> BoostedTrees {
    let (bins, mut draws) = (Bins::of(&sample.columns), Draws::new(seed, stream));
    let first = sample.targets.iter().sum::<f64>() / sample.len() as f64;
    // Residuals of the trees so far, which are the negative gradient of the squared error.
    let mut left: Vec<f64> = sample.targets.iter().map(|target| target - first).collect();
    let inputs: Vec<Vec<f64>> = (0..sample.len()).map(|k| sample.row(k)).collect();
    // At least one sample, however small the share is.
    let count = ((boosting.sampled * sample.len() as f64).ceil() as usize).max(1);
    let mut trees = Vec::with_capacity(boosting.trees);
    for _ in 0..boosting.trees {
        let mut rows = draws.some_of(count, sample.len());
        // Rows in ascending order are read from memory in sequence.
        rows.sort_unstable();
        // The tree is stored with the learning rate included, so that a prediction is a plain sum.
        let tree = grow(&bins, &left, rows, growth, &mut draws).times(boosting.rate);
        left.iter_mut().zip(&inputs).for_each(|(left, inputs)| *left -= tree.answer(inputs));
        trees.push(tree);
    }
    BoostedTrees { first, trees }
}

impl BoostedTrees {
    /// Prediction: the sum over all trees.
    pub fn answer(&self, inputs: &[f64]) -> f64 {
        self.first + self.trees.iter().map(|tree| tree.answer(inputs)).sum::<f64>()
    }
}
