//! Path of ridge solutions about zero in coordinates in which the prior is white, with its errors
//! on held-out samples: matrix products after one eigendecomposition, for thousands of ships per
//! second.

use nalgebra::{DMatrix, DVector, DVectorView, SymmetricEigen};

use super::RegressionMoments;

/// Decomposed statistics of some samples.
#[derive(Debug, Clone)]
pub struct WhitenedPath {
    /// Eigenvalues of the regressors' covariance.
    eigenvalues: DVector<f64>,
    eigenvectors: DMatrix<f64>,
    /// Covariances with the targets in the eigenbasis, one column for each target.
    data: DMatrix<f64>,
    target_variance: Vec<f64>,
    count: f64,
}

impl WhitenedPath {
    /// Decomposes the statistics once.
    pub fn new(moments: &RegressionMoments) -> Self {
        let (covariance, cross) = moments.covariance_blocks();
        let SymmetricEigen { mut eigenvalues, eigenvectors } = SymmetricEigen::new(covariance);
        // Negative eigenvalues are rounding errors.
        eigenvalues.apply(|value| *value = value.max(0.0));
        let data = eigenvectors.transpose() * cross;
        let target_variance = (0..moments.targets()).map(|t| moments.target_variance(t)).collect();
        Self { eigenvalues, eigenvectors, data, target_variance, count: moments.count }
    }

    /// Eigenvectors as columns.
    pub fn eigenvector_basis(&self) -> &DMatrix<f64> {
        &self.eigenvectors
    }

    /// Number of samples.
    pub fn sample_count(&self) -> f64 {
        self.count
    }

    /// Lambda so small that the prior decides only the directions that the samples do not
    /// determine.
    pub fn least_lambda(&self) -> f64 {
        (1e-9 * self.eigenvalues.max()).max(f64::MIN_POSITIVE)
    }

    /// Solution for a target in the eigenbasis.
    pub fn eigenbasis_solution(&self, target: usize, lambda: f64) -> DVector<f64> {
        self.data.column(target).zip_map(&self.eigenvalues, |x, d| x / (d + lambda))
    }

    /// Posterior variances along the eigenvectors, relative to the residual variance.
    pub fn posterior_variances(&self, lambda: f64) -> DVector<f64> {
        self.eigenvalues.map(|d| 1.0 / (self.count * (d + lambda)))
    }

    /// Residual variance of a target at a solution, with the effective degrees of freedom of the
    /// ridge.
    pub fn residual_variance(&self, target: usize, lambda: f64) -> f64 {
        let terms = || {
            self.data
                .column(target)
                .into_iter()
                .zip(&self.eigenvalues)
                .map(|(x, d)| (x / (d + lambda), *x, *d))
        };
        let explained: f64 = terms().map(|(g, x, d)| g * (2.0 * x - d * g)).sum();
        let freedom: f64 = self.eigenvalues.iter().map(|d| d / (d + lambda)).sum();
        (self.target_variance[target] - explained).max(0.0) * self.count
            / (self.count - freedom - 1.0).max(1.0)
    }

    /// Mean squared errors of the solutions for each target at each lambda on other samples, for a
    /// model without intercept.
    pub fn held_out_errors(&self, lambdas: &[f64], left_out: &RegressionMoments) -> Vec<Vec<f64>> {
        let raw = left_out.raw_products();
        let p = self.eigenvalues.len();
        // An explicit transpose: nalgebra's product with a transposed matrix does not use the fast
        // kernel.
        let back = self.eigenvectors.transpose();
        let turned = &back * (raw.view((0, 0), (p, p)) * &self.eigenvectors);
        let cross = back * raw.view((0, p), (p, self.data.ncols()));
        // One matrix for all lambdas; each target scales its rows by its own data.
        let weights =
            DMatrix::from_fn(p, lambdas.len(), |k, l| 1.0 / (self.eigenvalues[k] + lambdas[l]));
        let of_target = |target: usize| {
            let mut solutions = weights.clone();
            solutions
                .column_iter_mut()
                .for_each(|mut column| column.component_mul_assign(&self.data.column(target)));
            let pulled = &turned * &solutions;
            let (own, linear) = (raw[(p + target, p + target)], cross.column(target));
            let error = |(g, pulled): (DVectorView<'_, f64>, DVectorView<'_, f64>)| {
                // E[(y - x'g)^2] = E[y^2] + g' E[x x'] g - 2 g' E[x y], in the eigenbasis.
                own + g.dot(&pulled) - 2.0 * g.dot(&linear)
            };
            solutions.column_iter().zip(pulled.column_iter()).map(error).collect()
        };
        (0..self.data.ncols()).map(of_target).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{RidgeChoice, RidgePath, ValidationSamples};
    use super::*;

    fn columns(phase: f64) -> Vec<Vec<f64>> {
        let column = |f: &dyn Fn(f64) -> f64| {
            (0..300).map(|k| f(f64::from(k) + phase)).collect::<Vec<f64>>()
        };
        let (x, z) = (column(&|k| (0.11 * k).sin()), column(&|k| 3.0 + (0.07 * k).cos()));
        let y = x
            .iter()
            .zip(&z)
            .enumerate()
            .map(|(k, (x, z))| 2.0 * x - 0.5 * z + 0.1 * (7.0 * k as f64).sin())
            .collect();
        vec![x, z, y]
    }

    /// Against the path that keeps the source apart, with regressors in units of their deviation.
    #[test]
    fn about_the_source_it_is_the_published_path() {
        let (training, left_out) = (
            RegressionMoments::from_columns(&columns(0.0), 2),
            RegressionMoments::from_columns(&columns(500.0), 2),
        );
        let source = [1.5, -1.0];
        let deviation = |j: usize| training.regressor_variance(j).sqrt();
        let map = DMatrix::from_row_slice(
            3,
            3,
            &[
                1.0 / deviation(0),
                0.0,
                -source[0],
                0.0,
                1.0 / deviation(1),
                -source[1],
                0.0,
                0.0,
                1.0,
            ],
        );
        let whitened = WhitenedPath::new(&training.map_linear(&map, 2));
        let path = RidgePath::new(&training, &[source.to_vec()]);
        let lambdas = [1e-4, 0.1, 10.0];
        let errors = &whitened.held_out_errors(&lambdas, &left_out.map_linear(&map, 2))[0];
        for (lambda, error) in lambdas.into_iter().zip(errors) {
            let choice = RidgeChoice { lambda, alpha: 0.0 };
            let direct = path.solve_target(0, choice, &source);
            let solved = whitened.eigenvector_basis() * whitened.eigenbasis_solution(0, lambda);
            (0..2).for_each(|j| {
                assert!((source[j] + solved[j] / deviation(j) - direct[j]).abs() < 1e-10)
            });
            let by_alpha =
                path.error_by_alpha(0, lambda, &source, &ValidationSamples::new(&left_out));
            let expected = by_alpha.error_at(0.0);
            assert!((error - expected).abs() < 1e-10, "{lambda}: {error} {expected}");
            assert!(
                (whitened.residual_variance(0, lambda) - path.residual_variance(0, choice)).abs()
                    < 1e-10
            );
        }
    }

    /// Of two targets, against the samples themselves and the inverse of the covariance.
    #[test]
    fn solutions_and_variances_are_those_of_the_normal_equations() {
        let mut columns = columns(0.0);
        let other = (0..300).map(|k| (0.23 * f64::from(k)).cos() + 0.5 * columns[0][k as usize]);
        columns.push(other.collect());
        let moments = RegressionMoments::from_columns(&columns, 2);
        let whitened = WhitenedPath::new(&moments);
        let lambda = 0.2;
        let (covariance, cross) = moments.covariance_blocks();
        let inverse = (&covariance + DMatrix::identity(2, 2) * lambda).try_inverse().unwrap();
        assert_eq!(whitened.sample_count(), 300.0);
        let spread = DMatrix::from_diagonal(&whitened.posterior_variances(lambda));
        let variances =
            whitened.eigenvector_basis() * spread * whitened.eigenvector_basis().transpose();
        assert!((variances - &inverse / 300.0).amax() < 1e-14);
        let freedom = (&covariance * &inverse).trace();
        for target in 0..2 {
            let solved =
                whitened.eigenvector_basis() * whitened.eigenbasis_solution(target, lambda);
            assert!((&solved - &inverse * cross.column(target)).amax() < 1e-12);
            let own = &columns[2 + target];
            let left = |k: usize| own[k] - solved[0] * columns[0][k] - solved[1] * columns[1][k];
            let mean = (0..300).map(left).sum::<f64>() / 300.0;
            let squares: f64 = (0..300).map(|k| (left(k) - mean).powi(2)).sum();
            let direct = squares / (300.0 - freedom - 1.0);
            assert!((whitened.residual_variance(target, lambda) - direct).abs() < 1e-10);
        }
    }

    #[test]
    fn the_least_lambda_is_a_billionth_of_the_largest_eigenvalue() {
        let moments = RegressionMoments::from_columns(&columns(0.0), 2);
        let largest = moments.covariance_blocks().0.symmetric_eigen().eigenvalues.max();
        let own = WhitenedPath::new(&moments).least_lambda();
        assert!((own / (1e-9 * largest) - 1.0).abs() < 1e-12);
        let still = RegressionMoments::from_columns(&[vec![2.0; 9], vec![3.0; 9], vec![1.0; 9]], 2);
        assert_eq!(WhitenedPath::new(&still).least_lambda(), f64::MIN_POSITIVE);
    }
}
