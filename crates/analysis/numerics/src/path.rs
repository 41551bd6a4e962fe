//! Ridge regression with the source's coefficients as l2 prior: Kanazawa 2023, Eqs. 5.11-5.17.
//!
//! With z-scored regressors, `C` their correlation matrix and `b` the mean products with the
//! target, `beta' = (C + lambda I)^-1 (b + lambda (1 - alpha) beta'_source)`. One symmetric
//! eigendecomposition of `C` gives the solution for every (lambda, alpha); no matrix is inverted.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{AlphaError, PriorMetric, RegressionMoments};

/// Solutions of one set of samples and one source for all (lambda, alpha).
#[derive(Debug, Clone)]
pub struct RidgePath {
    metric: PriorMetric,
    eigenvalues: DVector<f64>,
    eigenvectors: DMatrix<f64>,
    /// For each target, the contributions of the data and of the source in the eigenbasis.
    data: Vec<DVector<f64>>,
    source: Vec<DVector<f64>>,
    target_variance: Vec<f64>,
    count: f64,
}

/// Point of the path: strength of the prior, and the share of the source that is replaced by zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RidgeChoice {
    /// Strength of the prior.
    pub lambda: f64,
    /// Share of the zero vector in the prior.
    pub alpha: f64,
}

impl RidgePath {
    /// Decomposes the statistics once; `source[t]` holds the prior coefficients of target `t`, in
    /// the units of the regressors. A regressor that does not vary keeps its source value.
    pub fn new(moments: &RegressionMoments, source: &[Vec<f64>]) -> Self {
        Self::with_shrinkage(moments, source, &vec![1.0; moments.regressors()])
    }

    /// Creates the path of a prior whose precision is `shrinkage[j]` times the common one for
    /// regressor `j`: its coefficient is measured by the standard deviation times the root of its
    /// shrinkage.
    pub fn with_shrinkage(
        moments: &RegressionMoments,
        source: &[Vec<f64>],
        shrinkage: &[f64],
    ) -> Self {
        Self::with_metric(moments, source, PriorMetric::of_regressors(moments, shrinkage))
    }

    /// Creates the path with any metric of the coefficients.
    pub fn with_metric(
        moments: &RegressionMoments,
        source: &[Vec<f64>],
        metric: PriorMetric,
    ) -> Self {
        let SymmetricEigen { eigenvalues, eigenvectors } =
            SymmetricEigen::new(metric.regressor_products(moments));
        let targets = 0..moments.targets();
        let data = targets
            .clone()
            .map(|t| tr_mul(&eigenvectors, &metric.products_with_target(moments, t)))
            .collect();
        let source = source.iter().map(|beta| {
            tr_mul(&eigenvectors, &(metric.root_matrix() * DVector::from_column_slice(beta)))
        });
        let source = source.collect();
        let target_variance = targets.map(|t| moments.target_variance(t)).collect();
        // A correlation matrix is positive semidefinite; negative eigenvalues are rounding errors.
        let eigenvalues = eigenvalues.map(|value| value.max(0.0));
        Self {
            metric,
            eigenvalues,
            eigenvectors,
            data,
            source,
            target_variance,
            count: moments.count,
        }
    }

    /// Coefficients of a target in the units of the regressors.
    pub fn solve_target(&self, target: usize, choice: RidgeChoice, source: &[f64]) -> Vec<f64> {
        let (from_data, from_source) = self.solution_parts(target, choice.lambda);
        self.to_coefficients(&(from_data + from_source * (1.0 - choice.alpha)), source)
    }

    /// Returns the two vectors of which every solution at `lambda` is `data + (1 - alpha) source`,
    /// in the coordinates of the metric.
    fn solution_parts(&self, target: usize, lambda: f64) -> (DVector<f64>, DVector<f64>) {
        let divide = |v: &DVector<f64>, by: f64| {
            v.zip_map(&self.eigenvalues, |x, d| by * x / (d + lambda).max(1e-300))
        };
        let data = &self.eigenvectors * divide(&self.data[target], 1.0);
        let source = &self.eigenvectors * divide(&self.source[target], lambda);
        (data, source)
    }

    /// Coefficients in the units of the regressors; a fixed one keeps its source value.
    fn to_coefficients(&self, beta: &DVector<f64>, source: &[f64]) -> Vec<f64> {
        let coefficients = self.metric.inverse_root() * beta;
        let one = |(j, kept): (usize, &f64)| {
            if self.metric.is_fixed(j) { *kept } else { coefficients[j] }
        };
        source.iter().enumerate().map(one).collect()
    }

    /// Mean squared error at `lambda` on held-out samples as a function of alpha, for the model
    /// without intercept.
    pub fn error_by_alpha(
        &self,
        target: usize,
        lambda: f64,
        source: &[f64],
        validation: &ValidationSamples,
    ) -> AlphaError {
        let (data, prior) = self.solution_parts(target, lambda);
        // The solution is fixed + (1 - alpha) along, so its squared error is quadratic in alpha.
        let fixed = self.to_coefficients(&data, source);
        let zero = vec![0.0; source.len()];
        let along = self.to_coefficients(&prior, &zero);
        validation.error_along(target, &fixed, &along)
    }

    /// Residual variance of a target at a solution, from the statistics alone, with the effective
    /// degrees of freedom of the ridge.
    pub fn residual_variance(&self, target: usize, choice: RidgeChoice) -> f64 {
        let solution = |i: usize| {
            // Solution in the eigenbasis: (data + lambda (1 - alpha) source) / (d + lambda).
            let pull = choice.lambda * (1.0 - choice.alpha) * self.source[target][i];
            (self.data[target][i] + pull) / (self.eigenvalues[i] + choice.lambda).max(1e-300)
        };
        // In the eigenbasis: g (2 b - d g) is the part of the variance explained by each direction.
        let explained: f64 = (0..self.eigenvalues.len())
            .map(|i| solution(i) * (2.0 * self.data[target][i] - self.eigenvalues[i] * solution(i)))
            .sum();
        // One more for the mean.
        let freedom = self.effective_count(choice.lambda);
        let mean = (self.target_variance[target] - explained).max(0.0);
        mean * self.count / (self.count - freedom - 1.0).max(1.0)
    }

    /// Effective number of parameters that the samples determine at `lambda`, the sum of `d/(d +
    /// lambda)` over the eigenvalues (Hastie, Tibshirani and Friedman 2009, The elements of
    /// statistical learning, Eq. 3.50).
    pub fn effective_count(&self, lambda: f64) -> f64 {
        self.eigenvalues.iter().map(|d| d / (d + lambda).max(1e-300)).sum()
    }

    /// Mean square of a target about its mean, or about zero if the statistics are about zero.
    pub fn target_variance(&self, target: usize) -> f64 {
        self.target_variance[target]
    }

    /// Misfit of a strength of the prior: minus twice the logarithm of the marginal likelihood per
    /// sample, with the residual variance at its maximum-likelihood value and without terms that do
    /// not depend on lambda. If the prior has the variance `s^2/(n lambda)` about the source, the
    /// samples less the prediction of the source are normal with eigenvalues `s^2 (d +
    /// lambda)/lambda` in the eigenbasis (MacKay 1992, Neural Computation 4, 415-447, section 3).
    pub fn evidence_misfit(&self, target: usize, lambda: f64) -> f64 {
        let (data, source, d) = (&self.data[target], &self.source[target], &self.eigenvalues);
        let terms = || data.iter().zip(source).zip(d).map(|((z, s), d)| (*z, *s, *d));
        // Variance of the residual of the source's prediction.
        let unexplained = self.target_variance[target]
            + terms().map(|(z, s, d)| s * (d * s - 2.0 * z)).sum::<f64>();
        let gained: f64 = terms().map(|(z, s, d)| (z - d * s).powi(2) / (d + lambda)).sum();
        // Logarithm of the determinant of the samples' covariance.
        let width: f64 = d.iter().map(|d| (1.0 + d / lambda).ln()).sum();
        (unexplained - gained).max(1e-300).ln() + width / self.count.max(1.0)
    }

    /// Posterior standard deviations of the coefficients at residual variance 1, and those of the
    /// prior, both in the units of the regressors.
    pub fn coefficient_deviations(&self, lambda: f64) -> Vec<(f64, f64)> {
        // Posterior covariance n^-1 (C + lambda I)^-1 in the eigenbasis.
        let weights = self.eigenvalues.map(|d| 1.0 / (self.count * (d + lambda).max(1e-300)));
        let directions = self.metric.inverse_root() * &self.eigenvectors;
        let posterior = |j: usize| {
            directions.row(j).iter().zip(weights.iter()).map(|(v, w)| v * v * w).sum::<f64>()
        };
        let prior = 1.0 / (self.count * lambda.max(1e-300));
        let held = |j: usize| prior * self.metric.inverse_root().row(j).norm_squared();
        (0..self.metric.coefficient_count())
            .map(|j| (posterior(j).sqrt(), held(j).sqrt()))
            .collect()
    }

    /// Half the second derivative of the cost at a solution with `lambda`, the sum of squares plus
    /// the penalty of the prior, in the units of the regressors; 1 for a regressor that does not
    /// vary.
    pub fn cost_curvature(&self, lambda: f64) -> DMatrix<f64> {
        let weights = self.eigenvalues.map(|d| self.count * (d + lambda));
        let standard =
            &self.eigenvectors * DMatrix::from_diagonal(&weights) * self.eigenvectors.transpose();
        // Chain rule: coordinates are root times coefficients.
        let own = self.metric.root_matrix().transpose() * standard * self.metric.root_matrix();
        let still = |j: usize| self.metric.is_fixed(j);
        DMatrix::from_fn(
            self.metric.coefficient_count(),
            self.metric.coefficient_count(),
            |i, j| match still(i) || still(j) {
                true => f64::from(u8::from(i == j)),
                false => own[(i, j)],
            },
        )
    }

    /// Largest eigenvalue of the correlation matrix divided by the smallest of those that belong to
    /// varying regressors.
    pub fn condition_number(&self) -> f64 {
        let still =
            (0..self.metric.coefficient_count()).filter(|j| self.metric.is_fixed(*j)).count();
        let mut values: Vec<f64> = self.eigenvalues.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        // Each regressor without variation adds an eigenvalue of zero.
        let smallest = values.get(still).copied().unwrap_or(0.0);
        values.last().map_or(1.0, |largest| largest / smallest.max(largest * f64::EPSILON))
    }

    /// Groups of regressors that the samples cannot distinguish: those that share an eigenvector
    /// whose eigenvalue is below `tolerance` of the largest.
    pub fn collinear_groups(&self, tolerance: f64) -> Vec<Vec<usize>> {
        let largest = self.eigenvalues.max();
        let small =
            (0..self.eigenvalues.len()).filter(|&i| self.eigenvalues[i] < tolerance * largest);
        let members = |i: usize| -> Vec<usize> {
            // Components of the eigenvector by coefficient, each scaled to its own size.
            let moved = self.metric.inverse_root() * self.eigenvectors.column(i);
            let moved = DVector::from_fn(moved.len(), |j, _| {
                moved[j] * self.metric.root_matrix().column(j).norm()
            })
            .normalize();
            // Members are the coefficients with a large component of the normalised eigenvector.
            (0..moved.len()).filter(|&j| moved[j].abs() > 0.3).collect()
        };
        let mut groups: Vec<Vec<usize>> =
            small.map(members).filter(|group| group.len() > 1).collect();
        groups.sort();
        groups.dedup();
        groups
    }
}

/// Product `V' x`, column by column: nalgebra's own transposed product is far slower.
fn tr_mul(matrix: &DMatrix<f64>, vector: &DVector<f64>) -> DVector<f64> {
    DVector::from_iterator(matrix.ncols(), matrix.column_iter().map(|column| column.dot(vector)))
}

/// Held-out samples on which solutions are evaluated, prepared once.
#[derive(Debug, Clone)]
pub struct ValidationSamples {
    raw: DMatrix<f64>,
    regressors: usize,
}

impl ValidationSamples {
    /// Creates them from their statistics.
    pub fn new(moments: &RegressionMoments) -> Self {
        Self { raw: moments.raw_products(), regressors: moments.regressors() }
    }

    /// Mean squared error of `fixed + w along`, with `w` the weight of the source.
    fn error_along(&self, target: usize, fixed: &[f64], along: &[f64]) -> AlphaError {
        let (p, t) = (self.regressors, self.regressors + target);
        // Expansion of E[(y - x'(fixed + w along))^2] in powers of w; one pass over the columns.
        let (mut cross, mut square, mut own, mut data, mut shift) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for j in 0..p {
            let column = self.raw.column(j);
            let (mut by_fixed, mut by_along) = (0.0, 0.0);
            for i in 0..p {
                by_fixed += column[i] * fixed[i];
                by_along += column[i] * along[i];
            }
            own += fixed[j] * by_fixed;
            cross += along[j] * by_fixed;
            square += along[j] * by_along;
            data += column[t] * fixed[j];
            shift += column[t] * along[j];
        }
        AlphaError {
            constant: self.raw[(t, t)] - 2.0 * data + own,
            linear: 2.0 * (cross - shift),
            square,
        }
    }
}

#[cfg(test)]
#[path = "path_tests.rs"]
mod tests;
