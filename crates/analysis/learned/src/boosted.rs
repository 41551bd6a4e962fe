//! Boosted trees on squared errors (Friedman 2002, Algorithm 1).

use serde::{Deserialize, Serialize};

use crate::draws::Draws;
use crate::sample::Sample;
use crate::tree::{Bins, Growth, Tree, grow};

/// A sum of trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoostedTrees {
    /// What is answered before the first tree.
    pub first: f64,
    /// What is added.
    pub trees: Vec<Tree>,
}

/// How a sum of trees is made.
#[derive(Debug, Clone, Copy)]
pub struct Boosting {
    /// How many trees.
    pub trees: usize,
    /// What a tree counts for.
    pub rate: f64,
    /// Share of the samples on which a tree grows.
    pub sampled: f64,
}

/// Adds tree after tree, each grown on what those before it leave of some samples.
pub fn train(
    sample: &Sample,
    boosting: Boosting,
    growth: Growth,
    seed: u64,
    stream: u64,
) -> BoostedTrees {
    let (bins, mut draws) = (Bins::of(&sample.columns), Draws::new(seed, stream));
    let first = sample.targets.iter().sum::<f64>() / sample.len() as f64;
    let mut left: Vec<f64> = sample.targets.iter().map(|target| target - first).collect();
    let inputs: Vec<Vec<f64>> = (0..sample.len()).map(|k| sample.row(k)).collect();
    let count = ((boosting.sampled * sample.len() as f64).ceil() as usize).max(1);
    let mut trees = Vec::with_capacity(boosting.trees);
    for _ in 0..boosting.trees {
        let mut rows = draws.some_of(count, sample.len());
        rows.sort_unstable();
        let tree = grow(&bins, &left, rows, growth, &mut draws).times(boosting.rate);
        left.iter_mut().zip(&inputs).for_each(|(left, inputs)| *left -= tree.answer(inputs));
        trees.push(tree);
    }
    BoostedTrees { first, trees }
}

impl BoostedTrees {
    /// The sum.
    pub fn answer(&self, inputs: &[f64]) -> f64 {
        self.first + self.trees.iter().map(|tree| tree.answer(inputs)).sum::<f64>()
    }
}
