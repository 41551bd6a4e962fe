//! Damped Gauss-Newton steps (Marquardt 1963, J Soc Ind Appl Math 11, 431-441).

use nalgebra::{DMatrix, DVector};

use super::normal::NormalEquations;
use super::prior::WeakFormPrior;
use super::thresholds::TRAJECTORY;

/// Normal equations with the prior, divided by the number of residual times.
pub(super) struct PenalisedEquations {
    pub hessian: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl PenalisedEquations {
    /// Combines the normal equations at coefficients with the prior there.
    pub fn new(
        normal: &NormalEquations,
        prior: &WeakFormPrior,
        pull: f64,
        at: &DVector<f64>,
    ) -> Self {
        let count = normal.count.max(1.0);
        let (mut hessian, mut gradient) = (&normal.hessian / count, &normal.gradient / count);
        prior.add_to_equations(at, pull, &mut hessian, &mut gradient);
        Self { hessian, gradient, cost: normal.cost / count + prior.cost(at, pull) }
    }

    /// Returns the step with every curvature increased by the share `damping`; `None` if the
    /// equations cannot be solved.
    pub fn damped_step(&self, damping: f64) -> Option<DVector<f64>> {
        let (mut scaled, scales) = self.scaled_hessian();
        scaled
            .iter_mut()
            .step_by(scales.len() + 1)
            .for_each(|diagonal| *diagonal += damping + TRAJECTORY.ridge);
        let right = self.gradient.component_mul(&scales);
        let step = scaled.cholesky()?.solve(&right);
        Some(-step.component_mul(&scales))
    }

    /// Returns the share of the cost that a step gains if the residuals are linear.
    pub fn predicted_gain(&self, step: &DVector<f64>) -> f64 {
        -(2.0 * self.gradient.dot(step) + step.dot(&(&self.hessian * step)))
            / self.cost.max(f64::MIN_POSITIVE)
    }

    /// The Hessian scaled to a diagonal of ones, and the scales.
    fn scaled_hessian(&self) -> (DMatrix<f64>, DVector<f64>) {
        let scales = self.hessian.diagonal().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 });
        let scaled = DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
            self.hessian[(i, j)] * scales[i] * scales[j]
        });
        (scaled, scales)
    }

    /// Returns the ratio of the extreme eigenvalues of the scaled Hessian.
    pub fn condition_number(&self) -> f64 {
        let values = self.scaled_hessian().0.symmetric_eigenvalues();
        let largest = values.max();
        largest / values.min().max(largest * f64::EPSILON)
    }

    /// Returns the inverse of the Hessian; `None` if it cannot be inverted.
    pub fn inverse_hessian(&self) -> Option<DMatrix<f64>> {
        let (mut scaled, scales) = self.scaled_hessian();
        scaled
            .iter_mut()
            .step_by(scales.len() + 1)
            .for_each(|diagonal| *diagonal += TRAJECTORY.ridge);
        let inverse = scaled.cholesky()?.inverse();
        Some(DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
            inverse[(i, j)] * scales[i] * scales[j]
        }))
    }
}
