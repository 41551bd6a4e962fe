//! How far a ridge's coefficients may be from the truth, jointly over the axes.
//!
//! With standardised regressors `F`, `C = F'F/n` and `S = C + lambda I`, the error of the ridge is
//! `S^-1 (F'e/n + lambda d)`, where `e` is what the law leaves of the accelerations and `d` how far the pull's target is
//! from the truth. Its covariance is `S^-1 (M + lambda^2 D) S^-1` whatever strength was chosen, and by whatever rule.
//!
//! `M` is the covariance of `F'e/n` for residuals that depend on each other (White 1980, Econometrica 48, 817-838; Newey
//! and West 1987, Econometrica 55, 703-708): [`Memory`] has their autocovariance, within and between the axes. `D` is not
//! what `lambda` would make of it, for that was chosen by simulation: [`spread`] learns from the trials how far the source
//! is off.

mod memory;
mod rows;
mod spread;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::posterior::Posterior;

use super::blocks::{Block, Blocks};
use super::published::{Choices, mixed_source};
use crate::regression::{Choice, Metric, Moments};
use memory::Memory;
pub(super) use rows::{Rows, rows};
use spread::spread;

/// Joint errors of coefficients, in their units.
#[derive(Debug, Clone)]
pub(super) struct Errors {
    /// The coefficients in the order of the matrices.
    pub names: Vec<String>,
    /// Covariance of the estimates.
    pub covariance: DMatrix<f64>,
    /// Covariance of the source about the truth.
    pub source: DMatrix<f64>,
    /// Covariance of the estimates' errors with the source's.
    pub cross: DMatrix<f64>,
}

impl Errors {
    /// The same for coefficients in another order; none where one is missing.
    pub fn ordered(&self, names: &[String]) -> Option<Self> {
        let place = |name: &String| self.names.iter().position(|own| own == name);
        let places: Vec<usize> = names.iter().map(place).collect::<Option<_>>()?;
        let of = |matrix: &DMatrix<f64>| matrix.select_rows(&places).select_columns(&places);
        let (covariance, source, cross) = (of(&self.covariance), of(&self.source), of(&self.cross));
        Some(Self { names: names.to_vec(), covariance, source, cross })
    }

    /// As a model keeps them; none where the covariance has no root.
    pub fn posterior(&self, model: &Model) -> Option<Posterior> {
        let deviations = self.covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let inverse = deviations.map(reciprocal);
        let size = self.names.len();
        let entry = |i: usize, j: usize| if i == j { 1.0 } else { self.covariance[(i, j)] * inverse[i] * inverse[j] };
        let correlation = DMatrix::from_fn(size, size, entry);
        let rooted = |slack: &f64| (&correlation * (1.0 - slack) + DMatrix::identity(size, size) * *slack).cholesky();
        let root = SLACK.iter().find_map(rooted)?.unpack();
        let names = self.names.clone();
        let values = names.iter().map(|name| model.coefficient(name)).collect();
        let root_correlation = Posterior::rows(size, &|i, j| root[(i, j)]);
        Some(Posterior { names, values, deviations: deviations.iter().copied().collect(), root_correlation })
    }
}

/// Shares of independence that are tried until a correlation matrix has a root.
const SLACK: [f64; 4] = [0.0, 1e-10, 1e-8, 1e-6];

/// One target of one regression.
struct Equation<'a> {
    block: usize,
    target: usize,
    choice: Choice,
    /// What standardises its coefficients.
    metric: &'a Metric,
    /// `C`, standardised.
    products: &'a DMatrix<f64>,
    /// `F'y/n`, standardised.
    data: DVector<f64>,
    /// Mean square of the target.
    square: f64,
    /// The source's coefficients, standardised.
    source: DVector<f64>,
    /// `S^-1`.
    inverse: DMatrix<f64>,
    /// The same at a strength that holds nothing which the trials can tell, and the solution there, standardised.
    free: (DMatrix<f64>, DVector<f64>),
}

/// The errors of the ridge at its choices; `rows` are those behind `moments`, `model` is the source. None where the
/// equations cannot be solved.
pub(super) fn errors(blocks: &Blocks, moments: &[Moments], rows: &Rows, model: &Model, choices: &Choices) -> Option<Errors> {
    let standard: Vec<(Metric, DMatrix<f64>)> = blocks.blocks.iter().zip(moments).map(standardised).collect();
    let mut equations = Vec::new();
    for (b, block) in blocks.blocks.iter().enumerate() {
        let sources = mixed_source(block, model);
        for (target, source) in sources.iter().enumerate() {
            equations.push(Equation::new((b, target), &moments[b], &standard[b], source, choices[b][target])?);
        }
    }
    let residuals: Vec<Vec<DVector<f64>>> = equations.iter().map(|equation| equation.residuals(rows)).collect();
    let memory = Memory::of(&residuals);
    let scatter = scatter(&equations, rows, &memory);
    let spreads: Vec<DVector<f64>> = equations.iter().zip(&scatter.own).map(|(e, own)| spread(e, own)).collect();
    Some(gathered(blocks, &equations, &scatter.all, &spreads))
}

/// What standardises a block's coefficients, and the mean products of its regressors so standardised.
fn standardised((block, moments): (&Block, &Moments)) -> (Metric, DMatrix<f64>) {
    let metric = block.metric(moments);
    let products = metric.products(moments);
    (metric, products)
}

/// One over a scale; 0 for what does not vary.
fn reciprocal(scale: f64) -> f64 {
    if scale > 0.0 { 1.0 / scale } else { 0.0 }
}

impl<'a> Equation<'a> {
    fn new(
        (block, target): (usize, usize),
        moments: &Moments,
        (metric, products): &'a (Metric, DMatrix<f64>),
        source: &[f64],
        choice: Choice,
    ) -> Option<Self> {
        let inverse = |lambda: f64| {
            let mut sum = products.clone();
            (0..metric.size()).for_each(|j| sum[(j, j)] += if metric.is_still(j) { 1.0 } else { lambda.max(1e-12) });
            Some(sum.cholesky()?.inverse())
        };
        let data = metric.products_with_target(moments, target);
        let source = metric.root() * DVector::from_column_slice(source);
        let lambda = choice.lambda.min(FREE);
        let free = inverse(lambda)?;
        let solution = &free * (&data + &source * lambda);
        let square = moments.target_variance(target);
        let (inverse, free) = (inverse(choice.lambda)?, (free, solution));
        Some(Self { block, target, choice, metric, products, data, square, source, inverse, free })
    }

    /// What the law leaves of its target, by sequence, where no source holds it: else the source's error would seem noise.
    fn residuals(&self, rows: &Rows) -> Vec<DVector<f64>> {
        let coefficients = self.metric.back() * &self.free.1;
        let of = |sequence: &rows::Sequence| sequence.target(self.target) - &sequence.regressors * &coefficients;
        rows.blocks[self.block].iter().map(of).collect()
    }

    /// Places of its coefficients that the trials moved.
    fn size(&self) -> usize {
        self.metric.size()
    }
}

/// Covariances of `F'e/n`.
struct Scatter {
    /// Over all equations one after the other.
    all: DMatrix<f64>,
    /// Of each alone.
    own: Vec<DMatrix<f64>>,
}

fn scatter(equations: &[Equation<'_>], rows: &Rows, memory: &Memory) -> Scatter {
    let starts = starts(equations);
    let total = starts.last().map_or(0, |start| start + equations[equations.len() - 1].size());
    let mut all = DMatrix::zeros(total, total);
    let mut factors = Vec::new();
    for (i, one) in equations.iter().enumerate() {
        for (j, other) in equations.iter().enumerate().take(i + 1) {
            let part = rows.weighed(one.block, other.block, &memory.kernel(i, j));
            let part = one.metric.back().transpose() * part * other.metric.back();
            if i == j {
                factors.push(one.taken_up(&part, memory.variance(i), rows.count()).sqrt());
            }
            all.view_mut((starts[i], starts[j]), part.shape()).copy_from(&part);
            all.view_mut((starts[j], starts[i]), (part.ncols(), part.nrows())).copy_from(&part.transpose());
        }
    }
    for (i, one) in equations.iter().enumerate() {
        all.rows_mut(starts[i], one.size()).scale_mut(factors[i]);
        all.columns_mut(starts[i], one.size()).scale_mut(factors[i]);
    }
    let own = equations.iter().zip(&starts).map(|(e, &at)| all.view((at, at), (e.size(), e.size())).into_owned()).collect();
    Scatter { all, own }
}

fn starts(equations: &[Equation<'_>]) -> Vec<usize> {
    let next = |at: &mut usize, equation: &Equation<'_>| {
        let start = *at;
        *at += equation.size();
        Some(start)
    };
    equations.iter().scan(0, next).collect()
}

impl Equation<'_> {
    /// By how much the residuals' variance is more than it seems, for the coefficients have taken up a part of it: with the
    /// hat matrix `A` and correlations `R`, the sum of squares is expected to be `tr (I - A) R (I - A)` of the variance.
    fn taken_up(&self, scatter: &DMatrix<f64>, variance: f64, count: f64) -> f64 {
        let unit = scatter * (count / variance.max(f64::MIN_POSITIVE));
        let moved = &self.free.0 * unit;
        let left = 1.0 - (2.0 * moved.trace() - (&moved * &self.free.0 * self.products).trace()) / count;
        1.0 / left.clamp(LEAST_LEFT, 1.0)
    }
}

/// Strength at which residuals are taken.
const FREE: f64 = 1e-5;
/// Where coefficients take up more than this leaves, residuals say nothing of their own size.
const LEAST_LEFT: f64 = 0.1;

/// From errors of standardised equations to those of the coefficients of each axis.
fn gathered(blocks: &Blocks, equations: &[Equation<'_>], scatter: &DMatrix<f64>, spreads: &[DVector<f64>]) -> Errors {
    let starts = starts(equations);
    let total = scatter.nrows();
    let (mut inverse, mut map) = (DMatrix::zeros(total, total), DMatrix::zeros(total, total));
    let (mut source, mut pulled) = (DVector::zeros(total), DVector::zeros(total));
    let mut strengths = DVector::zeros(total);
    let mut names = Vec::new();
    for ((equation, &at), spread) in equations.iter().zip(&starts).zip(spreads) {
        let (size, Choice { lambda, alpha }) = (equation.size(), equation.choice);
        inverse.view_mut((at, at), (size, size)).copy_from(&equation.inverse);
        pulled.rows_mut(at, size).copy_from(&(&equation.source * (lambda * alpha)));
        (0..size).filter(|j| !equation.metric.is_still(*j)).for_each(|j| {
            source[at + j] = spread[j];
            strengths[at + j] = lambda;
        });
    }
    for (b, block) in blocks.blocks.iter().enumerate() {
        let Some(first) = equations.iter().position(|equation| equation.block == b) else { continue };
        place(block, equations, &starts, first, &mut map);
        names.extend(block.names.iter().flatten().cloned());
    }
    let held = DMatrix::from_diagonal(&source.component_mul(&strengths).component_mul(&strengths));
    let covariance = &inverse * (scatter + held + &pulled * pulled.transpose()) * &inverse;
    let cross = &inverse * DMatrix::from_diagonal(&source.component_mul(&strengths));
    let mapped = |matrix: DMatrix<f64>| &map * matrix * map.transpose();
    Errors { names, covariance: mapped(covariance), source: mapped(DMatrix::from_diagonal(&source)), cross: mapped(cross) }
}

/// Coefficients of a block's axes from its targets' standardised ones.
fn place(block: &Block, equations: &[Equation<'_>], starts: &[usize], first: usize, map: &mut DMatrix<f64>) {
    let q = block.axes.len();
    let unmixing = block.mixing.clone().lu().solve(&DMatrix::identity(q, q)).unwrap_or_else(|| DMatrix::identity(q, q));
    for axis in 0..q {
        for target in 0..q {
            let part = equations[first + target].metric.back() * unmixing[(axis, target)];
            let size = block.regressors();
            map.view_mut((starts[first + axis], starts[first + target]), (size, size)).copy_from(&part);
        }
    }
}

#[cfg(test)]
mod tests;
