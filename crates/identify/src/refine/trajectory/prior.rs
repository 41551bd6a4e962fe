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
    /// What the source's pull at strength 1 is.
    pub own: DMatrix<f64>,
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
        let size = names.len();
        let (mut hessian, mut own) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        for (block, moments) in blocks.blocks.iter().zip(moments) {
            let raw = moments.raw_products();
            let weights: Vec<f64> = (block.regressors()..raw.nrows()).map(|t| 1.0 / raw[(t, t)].max(f64::MIN_POSITIVE)).collect();
            add_block(&mut hessian, block, (&raw, &weights), &place);
            if let Some(precision) = &block.precision {
                add_block(&mut own, block, (precision, &weights), &place);
            }
        }
        for (block, name, shrinkage) in blocks.blocks.iter().flat_map(each) {
            if let (None, Some(&k)) = (&block.precision, place.get(name.as_str())) {
                own[(k, k)] = shrinkage * hessian[(k, k)];
            }
        }
        let vector = |of: &dyn Fn(&str) -> f64| DVector::from_iterator(size, names.iter().map(|name| of(name)));
        Self { hessian, weak: vector(weak), source: vector(source), own }
    }

    /// What the pulls cost at coefficients.
    pub fn cost(&self, at: &DVector<f64>, strength: Strength) -> f64 {
        let (weak, source) = (at - &self.weak, at - &self.source);
        strength.mu * weak.dot(&(&self.hessian * &weak)) + strength.lambda * source.dot(&(&self.own * &source))
    }

    /// Adds the pulls to normal equations at coefficients.
    pub fn add(&self, at: &DVector<f64>, strength: Strength, hessian: &mut DMatrix<f64>, gradient: &mut DVector<f64>) {
        *hessian += &self.hessian * strength.mu;
        *gradient += &self.hessian * (at - &self.weak) * strength.mu;
        *hessian += &self.own * strength.lambda;
        *gradient += &self.own * (at - &self.source) * strength.lambda;
    }

    /// How far the source's pull alone lets each coefficient be, as if the motion were missed by its own size.
    pub fn deviations(&self, strength: Strength) -> DVector<f64> {
        let scales = self.own.diagonal().map(|own| 1.0 / own.max(1e-300).sqrt());
        let unit = DMatrix::from_fn(scales.len(), scales.len(), |i, j| self.own[(i, j)] * scales[i] * scales[j]);
        let free = DMatrix::identity(scales.len(), scales.len());
        let inverse = unit.cholesky().map_or(free, |root| root.inverse());
        DVector::from_fn(scales.len(), |k, _| inverse[(k, k)].sqrt() * scales[k] / strength.lambda.max(1e-300).sqrt())
    }
}

/// The coefficients of a block with how many times stronger the source pulls them than it pulls others.
fn each(block: &Block) -> impl Iterator<Item = (&Block, &String, f64)> {
    block.names.iter().flat_map(move |own| own.iter().zip(&block.shrinkage).map(move |(name, factor)| (block, name, *factor)))
}

/// Products of regressors by what each coefficient does to each acceleration.
fn add_block(
    into: &mut DMatrix<f64>,
    block: &Block,
    (products, weights): (&DMatrix<f64>, &[f64]),
    place: &BTreeMap<&str, usize>,
) {
    let placed = |names: &Vec<String>| names.iter().map(|name| place.get(name.as_str()).copied()).collect::<Vec<_>>();
    let places: Vec<Vec<Option<usize>>> = block.names.iter().map(placed).collect();
    for (a, rows) in places.iter().enumerate() {
        for (b, columns) in places.iter().enumerate() {
            let shared: f64 = weights.iter().enumerate().map(|(t, w)| w * block.mixing[(t, a)] * block.mixing[(t, b)]).sum();
            for (j, column) in columns.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    let (Some(row), Some(column)) = (row, column) else { continue };
                    into[(*row, *column)] += shared * products[(i, j)];
                }
            }
        }
    }
}
