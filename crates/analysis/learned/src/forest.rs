//! Random forests (Breiman 2001; Mei 2019, Table 1; Hastie and others 2009, Algorithm 15.1).

use rayon::prelude::*;

use crate::draws::Draws;
use crate::sample::Sample;
use crate::tree::{Bins, Growth, Tree, grow};

/// Grows trees, each on as many samples as there are, drawn with replacement. Every tree draws from
/// a stream of its own, so that the number of cores does not show.
pub fn train(sample: &Sample, trees: usize, growth: Growth, seed: u64, stream: u64) -> Vec<Tree> {
    let bins = Bins::of(&sample.columns);
    let one = |tree: u64| {
        let mut draws = Draws::new(seed, stream + tree);
        let mut rows: Vec<u32> =
            (0..sample.len()).map(|_| draws.below(sample.len()) as u32).collect();
        // In their order, neighbours in memory are read together.
        rows.sort_unstable();
        grow(&bins, &sample.targets, rows, growth, &mut draws)
    };
    (0..trees as u64).into_par_iter().map(one).collect()
}

/// The mean of the trees' answers.
pub fn answer(trees: &[Tree], inputs: &[f64]) -> f64 {
    trees.iter().map(|tree| tree.answer(inputs)).sum::<f64>() / trees.len() as f64
}
