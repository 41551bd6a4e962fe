//! Regression trees that split by the variance left (Breiman and others 1984; Hastie and others
//! 2009, Sec. 9.2.2), on inputs sorted into at most 256 bins.

use serde::{Deserialize, Serialize};

use crate::draws::Draws;

/// What a leaf has in place of an input.
const LEAF: u8 = u8::MAX;

/// A tree: nodes of an input, the place of the right child, and what the input is compared with.
/// The left child stands next to its parent; a leaf has its answer in place of the last.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tree(Vec<(u8, u32, f64)>);

impl Tree {
    /// The answer for inputs in deviations.
    #[inline]
    pub fn answer(&self, inputs: &[f64]) -> f64 {
        let mut at = 0;
        loop {
            let (input, right, value) = self.0[at];
            if input == LEAF {
                return value;
            }
            at = if inputs[usize::from(input)] <= value { at + 1 } else { right as usize };
        }
    }

    /// A node: the input of a split (none of a leaf), the place of the right child, and the bound
    /// of the split or the leaf's answer.
    pub fn node(&self, at: usize) -> (Option<usize>, usize, f64) {
        let (input, right, value) = self.0[at];
        ((input != LEAF).then_some(usize::from(input)), right as usize, value)
    }

    /// Whether every path ends in a leaf, and asks for inputs that there are.
    pub fn is_sound(&self, inputs: usize) -> bool {
        let within = |at: usize, &(input, right, value): &(u8, u32, f64)| {
            let right = right as usize;
            value.is_finite()
                && (input == LEAF
                    || (usize::from(input) < inputs && right > at + 1 && right < self.0.len()))
        };
        self.0.last().is_some_and(|last| last.0 == LEAF)
            && self.0.iter().enumerate().all(|(at, node)| within(at, node))
    }

    /// The same with its answers multiplied.
    pub fn times(mut self, factor: f64) -> Self {
        self.0.iter_mut().filter(|node| node.0 == LEAF).for_each(|node| node.2 *= factor);
        self
    }
}

/// Inputs sorted into bins by their quantiles.
pub struct Bins {
    /// The bin of each row, by input.
    codes: Vec<Vec<u8>>,
    /// The upper bound of each bin but the last, by input.
    edges: Vec<Vec<f64>>,
}

/// Most bins: what a byte holds.
const BINS: usize = 256;

impl Bins {
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let edges: Vec<Vec<f64>> = columns.iter().map(|column| edges(column)).collect();
        let code = |edges: &Vec<f64>, x: f64| edges.partition_point(|edge| *edge < x) as u8;
        let codes = columns.iter().zip(&edges);
        let codes = codes.map(|(column, edges)| column.iter().map(|x| code(edges, *x)).collect());
        Self { codes: codes.collect(), edges }
    }
}

/// Values halfway between neighbours at even steps through a sorted column.
fn edges(column: &[f64]) -> Vec<f64> {
    let mut sorted = column.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    let mut edges: Vec<f64> = (1..BINS)
        .map(|k| k * last / BINS)
        .filter(|&k| k < last && sorted[k] < sorted[k + 1])
        .map(|k| 0.5 * (sorted[k] + sorted[k + 1]))
        .collect();
    edges.dedup();
    edges
}

/// When a tree stops growing, and what it looks at.
#[derive(Debug, Clone, Copy)]
pub struct Growth {
    /// Fewest samples in a leaf.
    pub leaf: usize,
    /// Most splits from root to leaf.
    pub depth: usize,
    /// Inputs tried at each split.
    pub tried: usize,
}

/// Grows a tree on some rows; a row may be there more than once.
pub fn grow(
    bins: &Bins,
    targets: &[f64],
    rows: Vec<u32>,
    growth: Growth,
    draws: &mut Draws,
) -> Tree {
    let mut grower = Grower { bins, targets, growth, draws, tree: Tree::default() };
    grower.node(rows, growth.depth);
    grower.tree
}

struct Grower<'a> {
    bins: &'a Bins,
    targets: &'a [f64],
    growth: Growth,
    draws: &'a mut Draws,
    tree: Tree,
}

struct Split {
    input: usize,
    /// The last bin on the left.
    bin: usize,
    gain: f64,
}

impl Grower<'_> {
    fn node(&mut self, rows: Vec<u32>, depth: usize) {
        let sum: f64 = rows.iter().map(|row| self.targets[*row as usize]).sum();
        let may_split = depth > 0 && rows.len() >= 2 * self.growth.leaf;
        let split = if may_split { self.best(&rows, sum) } else { None };
        let Some(Split { input, bin, .. }) = split else {
            let mean = if rows.is_empty() { 0.0 } else { sum / rows.len() as f64 };
            return self.tree.0.push((LEAF, 0, mean));
        };
        let codes = &self.bins.codes[input];
        let (left, right): (Vec<u32>, Vec<u32>) =
            rows.into_iter().partition(|row| usize::from(codes[*row as usize]) <= bin);
        let at = self.tree.0.len();
        self.tree.0.push((input as u8, 0, self.bins.edges[input][bin]));
        self.node(left, depth - 1);
        self.tree.0[at].1 = self.tree.0.len() as u32;
        self.node(right, depth - 1);
    }

    /// The split that leaves the least variance, if any leaves less.
    fn best(&mut self, rows: &[u32], sum: f64) -> Option<Split> {
        let inputs = self.bins.codes.len();
        let mut tried = self.draws.some_of(self.growth.tried, inputs);
        tried.sort_unstable();
        let whole = sum * sum / rows.len() as f64;
        let mut best: Option<Split> = None;
        for input in tried {
            let Some(split) = self.best_of(input as usize, rows, sum) else { continue };
            let least = best.as_ref().map_or(whole * (1.0 + 1e-12), |best| best.gain);
            if split.gain > least {
                best = Some(split);
            }
        }
        best
    }

    fn best_of(&self, input: usize, rows: &[u32], sum: f64) -> Option<Split> {
        let mut bins = [(0_usize, 0.0_f64); BINS];
        let codes = &self.bins.codes[input];
        for row in rows {
            let bin = &mut bins[usize::from(codes[*row as usize])];
            *bin = (bin.0 + 1, bin.1 + self.targets[*row as usize]);
        }
        let (mut count, mut left) = (0, 0.0);
        let mut best: Option<Split> = None;
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
                best = Some(Split { input, bin, gain });
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

    fn grown(leaf: usize) -> Tree {
        let (columns, targets) = step();
        let growth = Growth { leaf, depth: 6, tried: 2 };
        let rows = (0..200).collect();
        grow(&Bins::of(&columns), &targets, rows, growth, &mut Draws::new(1, 0))
    }

    #[test]
    fn a_step_is_found_by_one_split() {
        let tree = grown(5);
        assert_eq!(tree.0.len(), 3, "{tree:?}");
        assert_eq!((tree.answer(&[0.0, 0.29]), tree.answer(&[0.0, 0.31])), (-1.0, 2.0));
        assert!(tree.is_sound(2) && !tree.is_sound(1));
    }

    #[test]
    fn small_leaves_are_not_made() {
        assert_eq!(grown(101).0.len(), 1);
    }

    #[test]
    fn a_circle_is_not_sound() {
        assert!(!Tree(vec![(0, 1, 0.0), (LEAF, 0, 1.0)]).is_sound(1));
        assert!(!Tree(vec![(0, 2, f64::NAN), (LEAF, 0, 1.0), (LEAF, 0, 1.0)]).is_sound(1));
        assert!(!Tree::default().is_sound(1));
    }
}
