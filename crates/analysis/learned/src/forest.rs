//! Random forests (Breiman 2001; Mei 2019, Table 1; Hastie and others 2009, Algorithm 15.1).

use rayon::prelude::*;

use crate::draws::RandomStream;
use crate::sample::TrainingSample;
use crate::tree::{GrowthSettings, InputBins, RegressionTree, grow_tree};

/// Grows trees, each on a bootstrap sample, drawn with replacement, of the same size. Every tree
/// has its own random number stream, so the result does not depend on the number of cores.
pub fn train_forest(
    sample: &TrainingSample,
    trees: usize,
    growth: GrowthSettings,
    seed: u64,
    stream: u64,
) -> Vec<RegressionTree> {
    let bins = InputBins::from_columns(&sample.columns);
    let one = |tree: u64| {
        let mut draws = RandomStream::new(seed, stream + tree);
        // Bootstrap: drawn with replacement, so rows may occur more than once.
        let mut rows: Vec<u32> =
            (0..sample.len()).map(|_| draws.integer_below(sample.len()) as u32).collect();
        // In ascending order, neighbours in memory are read together.
        rows.sort_unstable();
        grow_tree(&bins, &sample.targets, rows, growth, &mut draws)
    };
    (0..trees as u64).into_par_iter().map(one).collect()
}

/// Prediction: the mean over all trees.
pub fn predict_mean(trees: &[RegressionTree], inputs: &[f64]) -> f64 {
    trees.iter().map(|tree| tree.predict(inputs)).sum::<f64>() / trees.len() as f64
}
