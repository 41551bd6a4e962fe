//! What holds the coefficients: the weak form, with the source that holds it.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::super::blocks::{Block, Blocks};
use sistership_numerics::Moments;

/// What holds the coefficients: the weak form, by where its cost is least and how it rises from
/// there, and the source.
#[derive(Debug, Clone)]
pub(in super::super) struct WeakFormPrior {
    /// Half the second derivative of the weak form's cost, each acceleration by its mean square;
    /// the source's share is in it.
    pub hessian: DMatrix<f64>,
    pub weak: DVector<f64>,
    /// The source's share alone.
    pub of_source: DMatrix<f64>,
    source: DVector<f64>,
}

impl WeakFormPrior {
    /// For coefficients in an order, of the weak form on statistics, held by the source with a
    /// strength; `values` has the weak form's coefficient and the source's.
    pub fn new(
        names: &[String],
        blocks: &Blocks,
        moments: &[Moments],
        values: &dyn Fn(&str) -> (f64, f64),
        lambda: f64,
    ) -> Self {
        let place: BTreeMap<&str, usize> =
            names.iter().enumerate().map(|(k, name)| (name.as_str(), k)).collect();
        let size = names.len();
        let (mut hessian, mut of_source) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        for (block, moments) in blocks.blocks.iter().zip(moments) {
            let raw = moments.raw_products();
            let weights: Vec<f64> = (block.regressors()..raw.nrows())
                .map(|t| 1.0 / raw[(t, t)].max(f64::MIN_POSITIVE))
                .collect();
            add_block(&mut hessian, block, (&raw, &weights), &place);
            if let Some(precision) = &block.precision {
                add_block(&mut of_source, block, (precision, &weights), &place);
            }
        }
        for (block, name, shrinkage) in blocks.blocks.iter().flat_map(each) {
            if let (None, Some(&k)) = (&block.precision, place.get(name.as_str())) {
                of_source[(k, k)] = shrinkage * hessian[(k, k)];
            }
        }
        of_source *= lambda;
        hessian += &of_source;
        let (weak, source): (Vec<f64>, Vec<f64>) = names.iter().map(|name| values(name)).unzip();
        Self { hessian, weak: weak.into(), of_source, source: source.into() }
    }

    /// What it costs at coefficients, where the weak form pulls with a strength.
    pub fn cost(&self, at: &DVector<f64>, pull: f64) -> f64 {
        let (weak, source) = (at - &self.weak, at - &self.source);
        pull * weak.dot(&(&self.hessian * &weak))
            + by_source(pull) * source.dot(&(&self.of_source * &source))
    }

    /// Adds that to normal equations.
    pub fn add(
        &self,
        at: &DVector<f64>,
        pull: f64,
        hessian: &mut DMatrix<f64>,
        gradient: &mut DVector<f64>,
    ) {
        *hessian += &self.hessian * pull + &self.of_source * by_source(pull);
        gradient.gemv(pull, &self.hessian, &(at - &self.weak), 1.0);
        gradient.gemv(by_source(pull), &self.of_source, &(at - &self.source), 1.0);
    }

    /// How far the source alone, within the weak form and beside it, lets each coefficient be, as
    /// if the motion were missed by its own size.
    pub fn deviations(&self, pull: f64) -> DVector<f64> {
        let scales = self.of_source.diagonal().map(|own| 1.0 / own.max(1e-300).sqrt());
        let unit = DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
            self.of_source[(i, j)] * scales[i] * scales[j]
        });
        let free = DMatrix::identity(scales.len(), scales.len());
        let inverse = unit.cholesky().map_or(free, |root| root.inverse());
        DVector::from_fn(scales.len(), |k, _| {
            inverse[(k, k)].sqrt() * scales[k] / (pull + by_source(pull)).sqrt()
        })
    }
}

/// How strongly the source pulls by how it holds the weak form, where that pulls with a strength:
/// no more than so, and less where the weak form pulls little.
pub(super) fn by_source(pull: f64) -> f64 {
    pull / (1.0 + pull)
}

/// The coefficients of a block with how many times stronger the source pulls them than it pulls
/// others.
fn each(block: &Block) -> impl Iterator<Item = (&Block, &String, f64)> {
    block.names.iter().flat_map(move |own| {
        own.iter().zip(&block.shrinkage).map(move |(name, factor)| (block, name, *factor))
    })
}

/// Products of regressors by what each coefficient does to each acceleration.
fn add_block(
    into: &mut DMatrix<f64>,
    block: &Block,
    (products, weights): (&DMatrix<f64>, &[f64]),
    place: &BTreeMap<&str, usize>,
) {
    let placed = |names: &Vec<String>| {
        names.iter().map(|name| place.get(name.as_str()).copied()).collect::<Vec<_>>()
    };
    let places: Vec<Vec<Option<usize>>> = block.names.iter().map(placed).collect();
    for (a, rows) in places.iter().enumerate() {
        for (b, columns) in places.iter().enumerate() {
            let shared: f64 = weights
                .iter()
                .enumerate()
                .map(|(t, w)| w * block.mixing[(t, a)] * block.mixing[(t, b)])
                .sum();
            for (j, column) in columns.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    let (Some(row), Some(column)) = (row, column) else { continue };
                    into[(*row, *column)] += shared * products[(i, j)];
                }
            }
        }
    }
}
