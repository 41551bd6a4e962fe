//! Estimate of the error of a source, from the trials themselves.

use nalgebra::{DMatrix, DVector};

use super::equation::RidgeEquation;
use super::thresholds::POSTERIOR;

/// Returns the variances of the source's standardised coefficients about the true ones: a share of
/// their squares, and a common part, without which a term that the source does not have would be
/// certain to be zero. `F'y/n` less the source's prediction is `C d + F'e/n`, normal with
/// covariance `C D C + M`.
///
/// The results are the squares of the mean deviations over the posterior distribution of both
/// parts, with the prior `1/(1 + x^2)` for deviations in their unit (Gelman 2006, Bayesian Analysis
/// 1, 515-533). Means of the variances themselves would be dominated by the largest deviations that
/// cannot be excluded. `None` if a covariance is not positive definite.
pub(super) fn source_variances(
    equation: &RidgeEquation<'_>,
    scatter: &DMatrix<f64>,
) -> Option<DVector<f64>> {
    let (own, unit) = (equation.source.component_mul(&equation.source), equation.square);
    let variances =
        |relative: f64, common: f64| (&own * relative.powi(2)).add_scalar(common.powi(2) * unit);
    let Some(seen) = SpreadLikelihood::new(equation, scatter, &variances(1.0, 1.0)) else {
        return Some(variances(1.0, 1.0));
    };
    let before = |x: f64| (x / (1.0 + x * x)).ln();
    let pairs = POSTERIOR
        .relative
        .values()
        .flat_map(|relative| POSTERIOR.common.values().map(move |common| (relative, common)));
    let weighed: Vec<(DVector<f64>, f64)> = pairs
        .map(|(relative, common)| {
            let variances = variances(relative, common);
            // The grid is even in the logarithm: the prior has the factor `x` of the change of
            // variable.
            let weight = seen.log_likelihood(&variances)? + before(relative) + before(common);
            Some((variances, weight))
        })
        .collect::<Option<_>>()?;
    // Weights are taken relative to the largest one, against underflow.
    let most = weighed.iter().map(|(_, weight)| *weight).fold(f64::NEG_INFINITY, f64::max);
    let all: f64 = weighed.iter().map(|(_, weight)| (weight - most).exp()).sum();
    let none = DVector::zeros(own.len());
    let deviations = |variances: &DVector<f64>| variances.map(f64::sqrt);
    let mean = weighed.iter().fold(none, |sum, (variances, weight)| {
        sum + deviations(variances) * ((weight - most).exp() / all)
    });
    Some(mean.component_mul(&mean))
}

/// Likelihood of the source's variances in the eigenbasis of the regressors, each direction scaled
/// by its size.
struct SpreadLikelihood {
    surprise: DVector<f64>,
    /// Map from coefficients to directions.
    response: DMatrix<f64>,
    scatter: DMatrix<f64>,
}

impl SpreadLikelihood {
    fn new(
        equation: &RidgeEquation<'_>,
        scatter: &DMatrix<f64>,
        variances: &DVector<f64>,
    ) -> Option<Self> {
        let basis = equation.products.clone().symmetric_eigen();
        let least = POSTERIOR.silent * basis.eigenvalues.max();
        // Directions without regressors carry no information, and their rounding error would be
        // scaled up.
        let kept: Vec<usize> =
            (0..basis.eigenvalues.len()).filter(|&k| basis.eigenvalues[k] > least).collect();
        if kept.is_empty() {
            return None;
        }
        let vectors = basis.eigenvectors.select_columns(&kept);
        let mut surprise = vectors.tr_mul(&(&equation.data - equation.products * &equation.source));
        let mut response = vectors.transpose();
        response.row_iter_mut().zip(&kept).for_each(|(mut row, &k)| row *= basis.eigenvalues[k]);
        let mut scatter = vectors.tr_mul(scatter) * &vectors;
        let spread = weighted_gram(&response, variances);
        for k in 0..kept.len() {
            let size = 1.0 / (spread[(k, k)] + scatter[(k, k)]).max(1e-300).sqrt();
            surprise[k] *= size;
            response.row_mut(k).scale_mut(size);
            scatter.row_mut(k).scale_mut(size);
            scatter.column_mut(k).scale_mut(size);
        }
        Some(Self { surprise, response, scatter })
    }

    /// Logarithm of the likelihood of variances, but for a constant; `None` if the covariance is
    /// not positive definite.
    fn log_likelihood(&self, variances: &DVector<f64>) -> Option<f64> {
        let mut covariance = &self.scatter + weighted_gram(&self.response, variances);
        covariance
            .iter_mut()
            .step_by(self.surprise.len() + 1)
            .for_each(|diagonal| *diagonal += POSTERIOR.ridge);
        let factor = covariance.cholesky()?;
        let width: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        Some(-0.5 * self.surprise.dot(&factor.solve(&self.surprise)) - width)
    }
}

/// The product `A diag(w) A'`.
fn weighted_gram(matrix: &DMatrix<f64>, weights: &DVector<f64>) -> DMatrix<f64> {
    let mut scaled = matrix.clone();
    scaled.column_iter_mut().zip(weights.iter()).for_each(|(mut column, weight)| column *= *weight);
    scaled * matrix.transpose()
}
