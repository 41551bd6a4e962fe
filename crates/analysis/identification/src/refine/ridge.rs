//! The published estimator: each regression at its (lambda, alpha), and the transformation back to
//! the law's coefficients.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::coefficient::Axis;

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::errors::CoefficientErrors;
use super::outcome::RefineError;
use super::settings::TuningRange;
use super::thresholds::SELECTION;
use sistership_numerics::{
    AlphaError, RegressionMoments, RidgeChoice, RidgePath, ValidationSamples,
};

/// A coefficient as fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedCoefficient {
    /// Its value.
    pub value: f64,
    /// Posterior standard error.
    pub standard_error: f64,
    /// Standard deviation of the prior about the source: the root of its variance and of the square
    /// of the share that alpha shifts towards zero.
    pub prior_deviation: f64,
}

/// Coefficients fitted on some samples at a choice for each target of each regression.
#[derive(Debug, Clone)]
pub struct CoefficientFit {
    /// Coefficients by name, in the law's units.
    pub coefficients: BTreeMap<String, FittedCoefficient>,
    /// Nonlinear parameters of the law that were fitted, by name, in the law's units.
    pub parameters: BTreeMap<String, FittedCoefficient>,
    /// Largest condition number of the regressions.
    pub condition_number: f64,
    /// Groups of coefficients that the samples cannot distinguish.
    pub collinear_groups: Vec<Vec<String>>,
    /// Joint errors of the coefficients, where they were computed.
    pub(super) errors: Option<CoefficientErrors>,
}

/// Ridge choices of a law, by regression and target.
pub type RidgeChoices = Vec<Vec<RidgeChoice>>;

/// One regression with its decomposition.
struct PreparedRegression<'a> {
    block: &'a RegressionBlock,
    source: Vec<Vec<f64>>,
    path: RidgePath,
}

impl<'a> PreparedRegression<'a> {
    fn new(block: &'a RegressionBlock, moments: &RegressionMoments, model: &Model) -> Self {
        let source = mixed_source(block, model);
        Self {
            block,
            path: RidgePath::with_metric(moments, &source, block.prior_metric(moments)),
            source,
        }
    }

    /// The solution of each target at its choice.
    fn solve(&self, choices: &[RidgeChoice]) -> Vec<Vec<f64>> {
        let one = |(target, choice): (usize, &RidgeChoice)| {
            self.path.solve_target(target, *choice, &self.source[target])
        };
        choices.iter().enumerate().map(one).collect()
    }

    /// The error on held-out samples as a function of alpha.
    fn error_by_alpha(
        &self,
        target: usize,
        lambda: f64,
        held_out: &ValidationSamples,
    ) -> AlphaError {
        self.path.error_by_alpha(target, lambda, &self.source[target], held_out)
    }
}

/// The regressions of a training set, with the held-out samples that judge them.
pub struct RegressionFold<'a> {
    prepared: Vec<PreparedRegression<'a>>,
    validations: Vec<ValidationSamples>,
}

impl<'a> RegressionFold<'a> {
    /// Decomposes the training statistics (one set per regression) and prepares the held-out ones.
    pub fn new(
        blocks: &'a RegressionBlocks,
        model: &Model,
        training: &[RegressionMoments],
        left_out: &[RegressionMoments],
    ) -> Self {
        let prepared = blocks
            .blocks
            .iter()
            .zip(training)
            .map(|(block, moments)| PreparedRegression::new(block, moments, model))
            .collect();
        Self { prepared, validations: left_out.iter().map(ValidationSamples::new).collect() }
    }

    /// Returns the coefficients fitted on the training samples.
    pub fn solve(&self, choices: &RidgeChoices) -> BTreeMap<String, FittedCoefficient> {
        let mut coefficients = BTreeMap::new();
        self.prepared
            .iter()
            .zip(choices)
            .for_each(|(prepared, choices)| unmix_solutions(prepared, choices, &mut coefficients));
        coefficients
    }
}

impl RegressionFold<'_> {
    /// Effective number of coefficients that the samples determine, summed over the targets.
    pub(super) fn effective_count(&self, choices: &RidgeChoices) -> f64 {
        let of_targets = |(prepared, choices): (&PreparedRegression<'_>, &Vec<RidgeChoice>)| {
            choices.iter().map(|choice| prepared.path.effective_count(choice.lambda)).sum::<f64>()
        };
        self.prepared.iter().zip(choices).map(of_targets).sum()
    }

    /// Names of the coefficients, and half the second derivative by them of the objective of the
    /// fold's solution, each acceleration divided by its residual variance.
    pub(super) fn solution_curvature(&self, choices: &RidgeChoices) -> (Vec<String>, DMatrix<f64>) {
        let sizes =
            self.prepared.iter().map(|p| p.block.axes.len() * p.block.regressor_count()).sum();
        let (mut names, mut all) = (Vec::new(), DMatrix::zeros(sizes, sizes));
        for (prepared, choices) in self.prepared.iter().zip(choices) {
            let start = names.len();
            names.extend(prepared.block.names.iter().flatten().cloned());
            prepared.add_curvature(choices, start, &mut all);
        }
        (names, all)
    }
}

impl RegressionFold<'_> {
    /// The share of the mean square of each acceleration that remains on the held-out samples at a
    /// strength of the prior about the source.
    pub(super) fn error_shares(&self, lambda: f64) -> Vec<(Axis, f64)> {
        let of_block = |(prepared, validation): (&PreparedRegression<'_>, &ValidationSamples)| {
            let one = |(target, axis): (usize, &Axis)| {
                let error = prepared.error_by_alpha(target, lambda, validation).error_at(0.0);
                (*axis, error / prepared.path.target_variance(target).max(f64::MIN_POSITIVE))
            };
            prepared.block.axes.iter().enumerate().map(one).collect::<Vec<_>>()
        };
        self.prepared.iter().zip(&self.validations).flat_map(of_block).collect()
    }
}

impl PreparedRegression<'_> {
    /// Adds the curvature of this regression to the block of `all` that begins at `start`.
    fn add_curvature(&self, choices: &[RidgeChoice], start: usize, all: &mut DMatrix<f64>) {
        let (q, p) = (self.block.axes.len(), self.block.regressor_count());
        for (target, choice) in choices.iter().enumerate() {
            let variance = self.path.residual_variance(target, *choice).max(f64::MIN_POSITIVE);
            let own = self.path.cost_curvature(choice.lambda) / variance;
            for (a, b) in (0..q).flat_map(|a| (0..q).map(move |b| (a, b))) {
                // The unknowns of a target are `mixing[target, a]` times the coefficients of axis
                // `a`: the chain rule gives a block for each pair of axes.
                let shared = self.block.mixing[(target, a)] * self.block.mixing[(target, b)];
                let mut part = all.view_mut((start + a * p, start + b * p), (p, p));
                part += &own * shared;
            }
        }
    }
}

/// Returns the choices of a range with the least one-step error on held-out samples, for each
/// target of each regression.
///
/// # Errors
/// Returns an error with the axis whose error is not finite at any strength of the range.
pub fn tune_choices(
    folds: &[RegressionFold<'_>],
    range: &TuningRange,
    count: usize,
) -> Result<RidgeChoices, RefineError> {
    let Some(first) = folds.first() else { return Ok(RidgeChoices::new()) };
    let of_block = |b: usize| {
        let pairs: Vec<(&PreparedRegression<'_>, &ValidationSamples)> =
            folds.iter().map(|fold| (&fold.prepared[b], &fold.validations[b])).collect();
        let axes = first.prepared[b].block.axes.iter().enumerate();
        let of_axis = |(target, axis): (usize, &Axis)| {
            tune_target(target, &pairs, range, count).ok_or_else(|| {
                RefineError::Data(format!(
                    "the error on held-out samples of the {axis:?} axis is not finite at any \
                     strength of the prior: check the trials for values that are not finite"
                ))
            })
        };
        axes.map(of_axis).collect()
    };
    (0..first.prepared.len()).map(of_block).collect()
}

/// The lambda and alpha with the least sum of errors over the folds; `None` if no error is finite.
fn tune_target(
    target: usize,
    folds: &[(&PreparedRegression<'_>, &ValidationSamples)],
    range: &TuningRange,
    count: usize,
) -> Option<RidgeChoice> {
    let scored = |lambda: f64| {
        let of_fold = |(prepared, held_out): &(&PreparedRegression<'_>, &ValidationSamples)| {
            prepared.error_by_alpha(target, lambda, held_out)
        };
        // At a given lambda the error is a quadratic function of alpha: sums over folds add its
        // coefficients, and its minimum up to `alpha_max` is found directly.
        let (alpha, error) =
            folds.iter().map(of_fold).sum::<AlphaError>().least_error(range.alpha_max);
        (error, RidgeChoice { lambda, alpha })
    };
    let all = log_spaced(range.lambda_min, range.lambda_max, count).map(scored);
    let finite = all.filter(|(error, _)| error.is_finite());
    finite.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, choice)| choice)
}

/// The strengths with the greatest marginal likelihood on the given statistics, for each target of
/// each regression.
pub(super) fn most_likely(
    blocks: &RegressionBlocks,
    moments: &[RegressionMoments],
    model: &Model,
    range: &TuningRange,
    count: usize,
) -> RidgeChoices {
    let of_block = |(block, moments): (&RegressionBlock, &RegressionMoments)| {
        let prepared = PreparedRegression::new(block, moments, model);
        let of_target = |target: usize| {
            let misfit = |lambda: f64| (prepared.path.evidence_misfit(target, lambda), lambda);
            let all = log_spaced(range.lambda_min, range.lambda_max, count).map(misfit);
            let best = all
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map_or(range.lambda_max, |(_, lambda)| lambda);
            RidgeChoice { lambda: best, alpha: 0.0 }
        };
        (0..prepared.source.len()).map(of_target).collect()
    };
    blocks.blocks.iter().zip(moments).map(of_block).collect()
}

/// The strengths at which priors of known deviations count as much as the noise lets them, for each
/// target of each regression: the share of its variance that the statistics leave, divided by the
/// number of independent rows (Gelman et al. 2013, Bayesian data analysis, Eq. 14.8, with a prior of
/// one deviation a coefficient). `overlapping` rows count as one.
pub(super) fn noise_strengths(
    blocks: &RegressionBlocks,
    moments: &[RegressionMoments],
    model: &Model,
    overlapping: f64,
) -> Vec<Vec<f64>> {
    let of_block = |(block, moments): (&RegressionBlock, &RegressionMoments)| {
        let path = PreparedRegression::new(block, moments, model).path;
        let of_target = |target: usize| {
            let free = RidgeChoice { lambda: SELECTION.free_strength, alpha: 0.0 };
            let left = path.residual_variance(target, free) / path.target_variance(target);
            let strength = left * overlapping / moments.count;
            if strength.is_finite() { strength } else { 0.0 }
        };
        (0..block.axes.len()).map(of_target).collect()
    };
    blocks.blocks.iter().zip(moments).map(of_block).collect()
}

/// Values evenly spaced in their logarithm.
fn log_spaced(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> {
    let (low, high) = (low.ln(), high.ln());
    (0..count).map(move |k| (low + (high - low) * k as f64 / (count - 1) as f64).exp())
}

/// The source's coefficients in the unknowns of the regression, by target.
pub(super) fn mixed_source(block: &RegressionBlock, model: &Model) -> Vec<Vec<f64>> {
    let q = block.axes.len();
    let mut mixed = vec![vec![0.0; block.regressor_count()]; q];
    for i in 0..block.regressor_count() {
        let own =
            DVector::from_iterator(q, block.names.iter().map(|names| model.coefficient(&names[i])));
        let seen = &block.mixing * own;
        (0..q).for_each(|target| mixed[target][i] = seen[target]);
    }
    mixed
}

impl CoefficientFit {
    /// Returns the fit with joint errors, from which each coefficient's standard error is set.
    pub(super) fn with_errors(mut self, errors: Option<CoefficientErrors>) -> Self {
        if let Some(errors) = &errors {
            for (k, name) in errors.names.iter().enumerate() {
                let parameter = self.parameters.get_mut(name);
                let fitted = self.coefficients.get_mut(name).into_iter().chain(parameter);
                fitted.for_each(|fitted| {
                    fitted.standard_error = errors.covariance[(k, k)].max(0.0).sqrt()
                });
            }
        }
        self.errors = errors;
        self
    }
}

/// Fits each regression at its choices on the given statistics (one set per regression).
pub fn fit_regressions(
    blocks: &RegressionBlocks,
    moments: &[RegressionMoments],
    model: &Model,
    choices: &RidgeChoices,
) -> CoefficientFit {
    let mut result = CoefficientFit {
        coefficients: BTreeMap::new(),
        parameters: BTreeMap::new(),
        condition_number: 1.0,
        collinear_groups: Vec::new(),
        errors: None,
    };
    for ((block, moments), choices) in blocks.blocks.iter().zip(moments).zip(choices) {
        let prepared = PreparedRegression::new(block, moments, model);
        unmix_solutions(&prepared, choices, &mut result.coefficients);
        result.condition_number = result.condition_number.max(prepared.path.condition_number());
        // A regressor is common to the axes of a block, so that their coefficients are collinear
        // together.
        for group in prepared.path.collinear_groups(SELECTION.collinear) {
            result.collinear_groups.push(group.iter().map(|&i| joined_names(block, i)).collect());
        }
    }
    result
}

/// Names of the coefficients that share a regressor, as `Y_v/N_v`.
fn joined_names(block: &RegressionBlock, i: usize) -> String {
    block.names.iter().map(|names| names[i].as_str()).collect::<Vec<_>>().join("/")
}

/// Transforms the unknowns of a regression back to the coefficients of each axis.
fn unmix_solutions(
    prepared: &PreparedRegression<'_>,
    choices: &[RidgeChoice],
    into: &mut BTreeMap<String, FittedCoefficient>,
) {
    let block = prepared.block;
    let q = block.axes.len();
    let solutions = prepared.solve(choices);
    let scatter: Vec<f64> = choices
        .iter()
        .enumerate()
        .map(|(t, choice)| prepared.path.residual_variance(t, *choice).sqrt())
        .collect();
    // Standard deviations of posterior and prior for residuals of variance one, by target and
    // regressor.
    let deviations: Vec<Vec<(f64, f64)>> =
        choices.iter().map(|choice| prepared.path.coefficient_deviations(choice.lambda)).collect();
    let unmixing = &block.unmixing;
    for i in 0..block.regressor_count() {
        let solved = DVector::from_iterator(q, solutions.iter().map(|solution| solution[i]));
        let own = unmixing * solved;
        for axis in 0..q {
            // Errors of different targets are treated as independent here; joint errors replace
            // them where they are computed.
            let spread = |of: &dyn Fn(usize) -> f64| {
                (0..q)
                    .map(|t| (unmixing[(axis, t)] * scatter[t] * of(t)).powi(2))
                    .sum::<f64>()
                    .sqrt()
            };
            let pulled = (0..q)
                .map(|t| unmixing[(axis, t)] * choices[t].alpha * prepared.source[t][i])
                .sum::<f64>();
            let fitted = FittedCoefficient {
                value: own[axis],
                standard_error: spread(&|t| deviations[t][i].0),
                prior_deviation: spread(&|t| deviations[t][i].1).hypot(pulled),
            };
            into.insert(block.names[axis][i].clone(), fitted);
        }
    }
}

#[cfg(test)]
#[path = "ridge_tests.rs"]
mod tests;
