//! Joint errors of a ridge's coefficients over the axes.
//!
//! With standardised regressors `F`, `C = F'F/n` and `S = C + lambda I`, the error of the ridge is
//! `S^-1 (F'e/n + lambda d)`, where `e` are the residuals of the accelerations and `d` is the
//! distance of the prior's mean from the truth. Its covariance is `S^-1 (M + lambda^2 D) S^-1`
//! whatever strength was chosen, and by whatever rule.
//!
//! `M` is the covariance of `F'e/n` for residuals that depend on each other (White 1980,
//! Econometrica 48, 817-838; Newey and West 1987, Econometrica 55, 703-708):
//! [`ResidualAutocovariance`] has their autocovariance, within and between the axes. `D` is not the
//! covariance that `lambda` implies, since that was chosen by simulation: the source's error is
//! estimated from the trials.

mod autocovariance;
mod equation;
mod rows;
mod source_variance;
mod thresholds;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::coefficient::Axis;

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::errors::CoefficientErrors;
use super::outcome::RefineError;
use super::ridge::{RidgeChoices, mixed_source};
use autocovariance::ResidualAutocovariance;
use equation::RidgeEquation;
pub(super) use rows::{SequenceTables, SequencedRows, sequence_rows};
use sistership_numerics::{PriorMetric, RegressionMoments, RidgeChoice};
use source_variance::source_variances;

/// Returns the errors of the ridge at its choices; `rows` are the rows behind `moments`, `model` is
/// the source.
///
/// # Errors
/// Returns an error with the axis whose equations are not positive definite.
pub(super) fn posterior_errors(
    blocks: &RegressionBlocks,
    moments: &[RegressionMoments],
    rows: &SequencedRows,
    model: &Model,
    choices: &RidgeChoices,
) -> Result<CoefficientErrors, RefineError> {
    let standard: Vec<(PriorMetric, DMatrix<f64>)> =
        blocks.blocks.iter().zip(moments).map(standardise_block).collect();
    let mut equations = Vec::new();
    for (b, block) in blocks.blocks.iter().enumerate() {
        let sources = mixed_source(block, model);
        for (target, source) in sources.iter().enumerate() {
            let equation = RidgeEquation::new(
                (b, target),
                &moments[b],
                &standard[b],
                source,
                choices[b][target],
            );
            equations.push(equation.ok_or_else(|| not_definite_error(block.axes[target]))?);
        }
    }
    // Residuals of all equations first: their covariance links the equations.
    let residuals: Vec<Vec<DVector<f64>>> =
        equations.iter().map(|equation| equation.free_residuals(rows)).collect();
    let memory = ResidualAutocovariance::from_residuals(&residuals);
    let scatter = score_covariance(&equations, rows, &memory);
    let of_equation = |(equation, own): (&RidgeEquation<'_>, &DMatrix<f64>)| {
        let axis = blocks.blocks[equation.block].axes[equation.target];
        source_variances(equation, own).ok_or_else(|| not_definite_error(axis))
    };
    let spreads: Vec<DVector<f64>> =
        equations.iter().zip(&scatter.own).map(of_equation).collect::<Result<_, _>>()?;
    Ok(joint_errors(blocks, &equations, &scatter.all, &spreads))
}

/// The error for an axis with a matrix that has no Cholesky root.
fn not_definite_error(axis: Axis) -> RefineError {
    RefineError::Data(format!(
        "the standard errors of the {axis:?} axis cannot be computed: its normal equations are not \
         positive definite; check the trials for values that are not finite"
    ))
}

/// The metric that standardises a block's coefficients, and the mean products of its regressors so
/// standardised.
fn standardise_block(
    (block, moments): (&RegressionBlock, &RegressionMoments),
) -> (PriorMetric, DMatrix<f64>) {
    let metric = block.prior_metric(moments);
    let products = metric.regressor_products(moments);
    (metric, products)
}

/// Covariance of `F'e/n`.
struct ScoreCovariance {
    /// Joint covariance over all equations, one after the other.
    all: DMatrix<f64>,
    /// Covariance of each equation alone.
    own: Vec<DMatrix<f64>>,
}

/// The covariance of `F'e/n` from the autocovariance of the residuals, corrected for the variance
/// that the coefficients have taken up.
fn score_covariance(
    equations: &[RidgeEquation<'_>],
    rows: &SequencedRows,
    memory: &ResidualAutocovariance,
) -> ScoreCovariance {
    let starts = equation_starts(equations);
    let total =
        starts.last().map_or(0, |start| start + equations[equations.len() - 1].coefficient_count());
    let mut all = DMatrix::zeros(total, total);
    let mut factors = Vec::new();
    for (i, one) in equations.iter().enumerate() {
        // Only the lower triangle is computed; the upper one is its transpose.
        for (j, other) in equations.iter().enumerate().take(i + 1) {
            let part =
                rows.weighted_products(one.block, other.block, &memory.weighted_kernel(i, j));
            let part = one.metric.inverse_root().transpose() * part * other.metric.inverse_root();
            // The correction of variance is known only on the diagonal; its root scales rows and
            // columns after the loop.
            if i == j {
                factors.push(
                    one.variance_correction(&part, memory.residual_variance(i), rows.count())
                        .sqrt(),
                );
            }
            all.view_mut((starts[i], starts[j]), part.shape()).copy_from(&part);
            all.view_mut((starts[j], starts[i]), (part.ncols(), part.nrows()))
                .copy_from(&part.transpose());
        }
    }
    for (i, one) in equations.iter().enumerate() {
        all.rows_mut(starts[i], one.coefficient_count()).scale_mut(factors[i]);
        all.columns_mut(starts[i], one.coefficient_count()).scale_mut(factors[i]);
    }
    let own = equations
        .iter()
        .zip(&starts)
        .map(|(e, &at)| {
            all.view((at, at), (e.coefficient_count(), e.coefficient_count())).into_owned()
        })
        .collect();
    ScoreCovariance { all, own }
}

/// First place of each equation's coefficients.
fn equation_starts(equations: &[RidgeEquation<'_>]) -> Vec<usize> {
    let next = |at: &mut usize, equation: &RidgeEquation<'_>| {
        let start = *at;
        *at += equation.coefficient_count();
        Some(start)
    };
    equations.iter().scan(0, next).collect()
}

/// Joint errors of the coefficients of each axis from those of the standardised equations.
fn joint_errors(
    blocks: &RegressionBlocks,
    equations: &[RidgeEquation<'_>],
    scatter: &DMatrix<f64>,
    spreads: &[DVector<f64>],
) -> CoefficientErrors {
    let starts = equation_starts(equations);
    let total = scatter.nrows();
    let (mut inverse, mut map) = (DMatrix::zeros(total, total), DMatrix::zeros(total, total));
    let (mut source, mut pulled) = (DVector::zeros(total), DVector::zeros(total));
    let mut strengths = DVector::zeros(total);
    let mut names = Vec::new();
    for ((equation, &at), spread) in equations.iter().zip(&starts).zip(spreads) {
        let (size, RidgeChoice { lambda, alpha }) = (equation.coefficient_count(), equation.choice);
        inverse.view_mut((at, at), (size, size)).copy_from(&equation.inverse);
        pulled.rows_mut(at, size).copy_from(&(&equation.source * (lambda * alpha)));
        // A regressor that never moves has no source error and no pull.
        (0..size).filter(|j| !equation.metric.is_fixed(*j)).for_each(|j| {
            source[at + j] = spread[j];
            strengths[at + j] = lambda;
        });
    }
    for (b, block) in blocks.blocks.iter().enumerate() {
        // Equations of a block are consecutive, one for each target.
        let Some(first) = equations.iter().position(|equation| equation.block == b) else {
            continue;
        };
        place_block(block, equations, &starts, first, &mut map);
        names.extend(block.names.iter().flatten().cloned());
    }
    // `S^-1 (M + lambda^2 D + pull pull') S^-1`; the pull is the bias by which alpha moves the
    // prior's mean towards zero.
    let held = DMatrix::from_diagonal(&source.component_mul(&strengths).component_mul(&strengths));
    let covariance = &inverse * (scatter + held + &pulled * pulled.transpose()) * &inverse;
    let cross = &inverse * DMatrix::from_diagonal(&source.component_mul(&strengths));
    let mapped = |matrix: DMatrix<f64>| &map * matrix * map.transpose();
    CoefficientErrors {
        names,
        covariance: mapped(covariance),
        source: mapped(DMatrix::from_diagonal(&source)),
        cross: mapped(cross),
    }
}

/// Writes the map from the standardised coefficients of a block's targets to the coefficients of
/// its axes.
fn place_block(
    block: &RegressionBlock,
    equations: &[RidgeEquation<'_>],
    starts: &[usize],
    first: usize,
    map: &mut DMatrix<f64>,
) {
    let q = block.axes.len();
    for axis in 0..q {
        for target in 0..q {
            let part =
                equations[first + target].metric.inverse_root() * block.unmixing[(axis, target)];
            let size = block.regressor_count();
            map.view_mut((starts[first + axis], starts[first + target]), (size, size))
                .copy_from(&part);
        }
    }
}

#[cfg(test)]
mod tests;
