//! The ridge of one target of one regression at its choice.

use nalgebra::{DMatrix, DVector};

use super::rows::{RowSequence, SequencedRows};
use super::thresholds::POSTERIOR;
use sistership_numerics::{PriorMetric, RegressionMoments, RidgeChoice};

/// The ridge of one target of one regression.
pub(super) struct RidgeEquation<'a> {
    pub block: usize,
    pub target: usize,
    pub choice: RidgeChoice,
    /// Metric that standardises its coefficients.
    pub metric: &'a PriorMetric,
    /// `C`, standardised.
    pub products: &'a DMatrix<f64>,
    /// `F'y/n`, standardised.
    pub data: DVector<f64>,
    /// Mean square of the target.
    pub square: f64,
    /// The source's coefficients, standardised.
    pub source: DVector<f64>,
    /// `S^-1`.
    pub inverse: DMatrix<f64>,
    /// `S^-1` at a strength so small that the source has no influence where the trials have
    /// information, and the solution there, standardised.
    pub free: (DMatrix<f64>, DVector<f64>),
}

impl<'a> RidgeEquation<'a> {
    /// Creates the equation; `None` if its normal equations are not positive definite.
    pub fn new(
        (block, target): (usize, usize),
        moments: &RegressionMoments,
        (metric, products): &'a (PriorMetric, DMatrix<f64>),
        source: &[f64],
        choice: RidgeChoice,
    ) -> Option<Self> {
        let inverse = |lambda: f64| {
            let mut sum = products.clone();
            (0..metric.coefficient_count()).for_each(|j| {
                sum[(j, j)] += if metric.is_fixed(j) { 1.0 } else { lambda.max(1e-12) }
            });
            Some(sum.cholesky()?.inverse())
        };
        let data = metric.products_with_target(moments, target);
        let source = metric.root_matrix() * DVector::from_column_slice(source);
        let lambda = choice.lambda.min(POSTERIOR.residual_strength);
        let free = inverse(lambda)?;
        let solution = &free * (&data + &source * lambda);
        let square = moments.target_variance(target);
        let (inverse, free) = (inverse(choice.lambda)?, (free, solution));
        Some(Self { block, target, choice, metric, products, data, square, source, inverse, free })
    }

    /// Residuals of the target by sequence, for the solution without influence of the source: the
    /// source's error would otherwise count as noise.
    pub fn free_residuals(&self, rows: &SequencedRows) -> Vec<DVector<f64>> {
        let coefficients = self.metric.inverse_root() * &self.free.1;
        let of = |sequence: &RowSequence| {
            sequence.target(self.target) - &sequence.regressors * &coefficients
        };
        rows.blocks[self.block].iter().map(of).collect()
    }

    /// Number of its coefficients.
    pub fn coefficient_count(&self) -> usize {
        self.metric.coefficient_count()
    }
}

impl RidgeEquation<'_> {
    /// Factor by which the residuals' variance exceeds its estimate, since the coefficients have
    /// taken up a part of it: with the hat matrix `A` and correlations `R`, the expected sum of
    /// squares is `tr (I - A) R (I - A)` times the variance.
    pub fn variance_correction(&self, scatter: &DMatrix<f64>, variance: f64, count: f64) -> f64 {
        let unit = scatter * (count / variance.max(f64::MIN_POSITIVE));
        let moved = &self.free.0 * unit;
        let left =
            1.0 - (2.0 * moved.trace() - (&moved * &self.free.0 * self.products).trace()) / count;
        1.0 / left.clamp(POSTERIOR.least_left, 1.0)
    }
}
