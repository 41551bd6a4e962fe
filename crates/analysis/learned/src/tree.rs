//! Regression trees that split by the remaining variance (Breiman and others 1984; Hastie and
//! others 2009, Sec. 9.2.2), on inputs sorted into at most 256 bins.

use serde::{Deserialize, Serialize};

use crate::draws::RandomStream;

/// Mark of a leaf in place of an input.
const LEAF: u8 = u8::MAX;

/// Regression tree: nodes of an input, the index of the right child, and the bound of the input.
/// The left child directly follows its parent; a leaf has its prediction in place of the bound.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RegressionTree(Vec<(u8, u32, f64)>);

impl RegressionTree {
    /// Prediction for inputs in standard deviations.
    #[inline]
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        let mut at = 0;
        loop {
            let (input, right, value) = self.0[at];
            if input == LEAF {
                return value;
            }
            // The left child is the next node.
            at = if inputs[usize::from(input)] <= value { at + 1 } else { right as usize };
        }
    }

    /// Node at an index: the input of a split (`None` for a leaf), the index of the right child,
    /// and the bound of the split or the leaf's prediction.
    pub fn node_at(&self, at: usize) -> (Option<usize>, usize, f64) {
        let (input, right, value) = self.0[at];
        ((input != LEAF).then_some(usize::from(input)), right as usize, value)
    }

    /// True if every path ends in a leaf and uses existing inputs.
    pub fn is_sound(&self, inputs: usize) -> bool {
        // Children stand after their parents, so that a prediction ends; the last node must be a
        // leaf.
        let within = |at: usize, &(input, right, value): &(u8, u32, f64)| {
            let right = right as usize;
            value.is_finite()
                && (input == LEAF
                    || (usize::from(input) < inputs && right > at + 1 && right < self.0.len()))
        };
        self.0.last().is_some_and(|last| last.0 == LEAF)
            && self.0.iter().enumerate().all(|(at, node)| within(at, node))
    }

    /// Returns the tree with its predictions multiplied by a factor.
    pub fn scaled_by(mut self, factor: f64) -> Self {
        self.0.iter_mut().filter(|node| node.0 == LEAF).for_each(|node| node.2 *= factor);
        self
    }
}

/// Inputs sorted into bins by their quantiles.
pub struct InputBins {
    /// Bin of each row, by input.
    codes: Vec<Vec<u8>>,
    /// Upper bound of each bin but the last, by input.
    edges: Vec<Vec<f64>>,
}

/// Largest number of bins: the values of a byte.
const MAX_BINS: usize = 256;

impl InputBins {
    /// Sorts the values of each column into bins.
    pub fn from_columns(columns: &[Vec<f64>]) -> Self {
        // Codes are bytes: a byte has as many values as there are bins.
        let edges: Vec<Vec<f64>> = columns.iter().map(|column| bin_edges(column)).collect();
        let code = |edges: &Vec<f64>, x: f64| edges.partition_point(|edge| *edge < x) as u8;
        let codes = columns.iter().zip(&edges);
        let codes = codes.map(|(column, edges)| column.iter().map(|x| code(edges, *x)).collect());
        Self { codes: codes.collect(), edges }
    }
}

/// Bounds halfway between neighbours at even steps through the sorted column.
fn bin_edges(column: &[f64]) -> Vec<f64> {
    let mut sorted = column.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    let mut edges: Vec<f64> = (1..MAX_BINS)
        .map(|k| k * last / MAX_BINS)
        // Equal neighbours share a bin.
        .filter(|&k| k < last && sorted[k] < sorted[k + 1])
        .map(|k| 0.5 * (sorted[k] + sorted[k + 1]))
        .collect();
    edges.dedup();
    edges
}

/// Limits of the growth of a tree.
#[derive(Debug, Clone, Copy)]
pub struct GrowthSettings {
    /// Smallest number of samples in a leaf.
    pub leaf: usize,
    /// Largest number of splits from root to leaf.
    pub depth: usize,
    /// Number of random inputs considered at each split.
    pub tried: usize,
}

/// Grows a tree on the given rows; a row may occur more than once.
pub fn grow_tree(
    bins: &InputBins,
    targets: &[f64],
    rows: Vec<u32>,
    growth: GrowthSettings,
    draws: &mut RandomStream,
) -> RegressionTree {
    let mut grower = TreeBuilder { bins, targets, growth, draws, tree: RegressionTree::default() };
    grower.grow_node(rows, growth.depth);
    grower.tree
}

/// State of a tree under construction.
struct TreeBuilder<'a> {
    bins: &'a InputBins,
    targets: &'a [f64],
    growth: GrowthSettings,
    draws: &'a mut RandomStream,
    tree: RegressionTree,
}

/// Split of the rows of a node.
struct NodeSplit {
    input: usize,
    /// Last bin on the left.
    bin: usize,
    gain: f64,
}

impl TreeBuilder<'_> {
    /// Adds the node of some rows, and its subtree, in depth-first order.
    fn grow_node(&mut self, rows: Vec<u32>, depth: usize) {
        let sum: f64 = rows.iter().map(|row| self.targets[*row as usize]).sum();
        // Both children of a split need the smallest number of samples.
        let may_split = depth > 0 && rows.len() >= 2 * self.growth.leaf;
        let split = if may_split { self.best_split(&rows, sum) } else { None };
        let Some(NodeSplit { input, bin, .. }) = split else {
            let mean = if rows.is_empty() { 0.0 } else { sum / rows.len() as f64 };
            return self.tree.0.push((LEAF, 0, mean));
        };
        let codes = &self.bins.codes[input];
        let (left, right): (Vec<u32>, Vec<u32>) =
            rows.into_iter().partition(|row| usize::from(codes[*row as usize]) <= bin);
        let at = self.tree.0.len();
        self.tree.0.push((input as u8, 0, self.bins.edges[input][bin]));
        self.grow_node(left, depth - 1);
        // The index of the right child is known once the left subtree is complete.
        self.tree.0[at].1 = self.tree.0.len() as u32;
        self.grow_node(right, depth - 1);
    }

    /// Returns the split of least remaining variance, if one reduces it.
    fn best_split(&mut self, rows: &[u32], sum: f64) -> Option<NodeSplit> {
        let inputs = self.bins.codes.len();
        let mut tried = self.draws.sample_indices(self.growth.tried, inputs);
        // Equal gains are decided by the order of inputs, not by the order of the draws.
        tried.sort_unstable();
        // The variance that remains is the sum of squares less sum^2/count of each side. The sum of
        // squares is common to all splits, so the largest gain has the least variance.
        let whole = sum * sum / rows.len() as f64;
        let mut best: Option<NodeSplit> = None;
        for input in tried {
            let Some(split) = self.best_input_split(input as usize, rows, sum) else { continue };
            // The first split must exceed the gain of no split by more than rounding.
            let least = best.as_ref().map_or(whole * (1.0 + 1e-12), |best| best.gain);
            if split.gain > least {
                best = Some(split);
            }
        }
        best
    }

    /// Returns the best split by one input.
    fn best_input_split(&self, input: usize, rows: &[u32], sum: f64) -> Option<NodeSplit> {
        // Count and sum of the targets in each bin; one pass over them then gives every split.
        let mut bins = [(0_usize, 0.0_f64); MAX_BINS];
        let codes = &self.bins.codes[input];
        for row in rows {
            let bin = &mut bins[usize::from(codes[*row as usize])];
            *bin = (bin.0 + 1, bin.1 + self.targets[*row as usize]);
        }
        let (mut count, mut left) = (0, 0.0);
        let mut best: Option<NodeSplit> = None;
        for (bin, (own_count, own_sum)) in
            bins.iter().enumerate().take(self.bins.edges[input].len())
        {
            (count, left) = (count + own_count, left + own_sum);
            let beyond = rows.len() - count;
            if count < self.growth.leaf || beyond < self.growth.leaf {
                continue;
            }
            let right: f64 = sum - left;
            let gain = left * left / count as f64 + right * right / beyond as f64;
            if best.as_ref().is_none_or(|best| gain > best.gain) {
                best = Some(NodeSplit { input, bin, gain });
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step() -> (Vec<Vec<f64>>, Vec<f64>) {
        let x: Vec<f64> = (0..200).map(|k| f64::from(k) / 100.0 - 1.0).collect();
        let noise = (0..200).map(|k| f64::from(k * 37 % 101)).collect();
        let y = x.iter().map(|x| if *x < 0.3 { -1.0 } else { 2.0 }).collect();
        (vec![noise, x], y)
    }

    fn grown(leaf: usize) -> RegressionTree {
        let (columns, targets) = step();
        let growth = GrowthSettings { leaf, depth: 6, tried: 2 };
        let rows = (0..200).collect();
        grow_tree(
            &InputBins::from_columns(&columns),
            &targets,
            rows,
            growth,
            &mut RandomStream::new(1, 0),
        )
    }

    #[test]
    fn a_step_is_found_by_one_split() {
        let tree = grown(5);
        assert_eq!(tree.0.len(), 3, "{tree:?}");
        assert_eq!((tree.predict(&[0.0, 0.29]), tree.predict(&[0.0, 0.31])), (-1.0, 2.0));
        assert!(tree.is_sound(2) && !tree.is_sound(1));
    }

    #[test]
    fn small_leaves_are_not_made() {
        assert_eq!(grown(101).0.len(), 1);
    }

    #[test]
    fn a_circle_is_not_sound() {
        assert!(!RegressionTree(vec![(0, 1, 0.0), (LEAF, 0, 1.0)]).is_sound(1));
        assert!(
            !RegressionTree(vec![(0, 2, f64::NAN), (LEAF, 0, 1.0), (LEAF, 0, 1.0)]).is_sound(1)
        );
        assert!(!RegressionTree::default().is_sound(1));
    }
}
