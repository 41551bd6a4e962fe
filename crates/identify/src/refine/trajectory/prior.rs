//! What holds the coefficients: the weak form and the source.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::super::blocks::{Block, Blocks};
use crate::regression::Moments;

/// Strengths of the two pulls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Strength {
    /// Towards the weak form.
    pub mu: f64,
    /// Towards the source.
    pub lambda: f64,
}

/// The weak form's Hessian and solution, and the source.
#[derive(Debug, Clone)]
pub(in super::super) struct Prior {
    /// By the mean square of each acceleration.
    pub hessian: DMatrix<f64>,
    pub weak: DVector<f64>,
    pub source: DVector<f64>,
    /// How many times stronger the source pulls each coefficient than it pulls others: deviations of submodels.
    shrinkage: DVector<f64>,
}

impl Prior {
    /// For coefficients in an order.
    pub fn new(
        names: &[String],
        blocks: &Blocks,
        moments: &[Moments],
        weak: &dyn Fn(&str) -> f64,
        source: &dyn Fn(&str) -> f64,
    ) -> Self {
        let place: BTreeMap<&str, usize> = names.iter().enumerate().map(|(k, name)| (name.as_str(), k)).collect();
        let mut hessian = DMatrix::zeros(names.len(), names.len());
        for (block, moments) in blocks.blocks.iter().zip(moments) {
            add_block(&mut hessian, block, moments, &place);
        }
        let vector = |of: &dyn Fn(&str) -> f64| DVector::from_iterator(names.len(), names.iter().map(|name| of(name)));
        let mut shrinkage = DVector::repeat(names.len(), 1.0);
        for (name, factor) in
            blocks.blocks.iter().flat_map(|block| block.names.iter().flat_map(|own| own.iter().zip(&block.shrinkage)))
        {
            place.get(name.as_str()).into_iter().for_each(|&k| shrinkage[k] = *factor);
        }
        Self { hessian, weak: vector(weak), source: vector(source), shrinkage }
    }

    /// What the pulls cost at coefficients.
    pub fn cost(&self, at: &DVector<f64>, strength: Strength) -> f64 {
        let (weak, source) = (at - &self.weak, at - &self.source);
        let own: f64 = source.iter().enumerate().map(|(k, d)| self.own(k) * d * d).sum();
        strength.mu * weak.dot(&(&self.hessian * &weak)) + strength.lambda * own
    }

    /// Adds the pulls to normal equations at coefficients.
    pub fn add(&self, at: &DVector<f64>, strength: Strength, hessian: &mut DMatrix<f64>, gradient: &mut DVector<f64>) {
        *hessian += &self.hessian * strength.mu;
        *gradient += &self.hessian * (at - &self.weak) * strength.mu;
        for k in 0..at.len() {
            let own = strength.lambda * self.own(k);
            hessian[(k, k)] += own;
            gradient[k] += own * (at[k] - self.source[k]);
        }
    }

    /// How far the source's pull alone lets a coefficient be, as if the motion were missed by its own size.
    pub fn deviation(&self, k: usize, strength: Strength) -> f64 {
        1.0 / (strength.lambda * self.own(k)).max(1e-300).sqrt()
    }

    /// What the source's pull at strength 1 is on a coefficient.
    pub fn own(&self, k: usize) -> f64 {
        self.shrinkage[k] * self.hessian[(k, k)]
    }
}

/// Products of regressors by what each coefficient does to each acceleration.
fn add_block(hessian: &mut DMatrix<f64>, block: &Block, moments: &Moments, place: &BTreeMap<&str, usize>) {
    let raw = moments.raw_products();
    let p = block.regressors();
    let weights: Vec<f64> = (0..block.axes.len()).map(|t| 1.0 / raw[(p + t, p + t)].max(f64::MIN_POSITIVE)).collect();
    for (a, names) in block.names.iter().enumerate() {
        for (b, others) in block.names.iter().enumerate() {
            let shared: f64 = weights.iter().enumerate().map(|(t, w)| w * block.mixing[(t, a)] * block.mixing[(t, b)]).sum();
            for (i, name) in names.iter().enumerate() {
                for (j, other) in others.iter().enumerate() {
                    let (Some(&row), Some(&column)) = (place.get(name.as_str()), place.get(other.as_str())) else { continue };
                    hessian[(row, column)] += shared * raw[(i, j)];
                }
            }
        }
    }
}
