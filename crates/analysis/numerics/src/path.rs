//! The ridge with the source's coefficients as l2 prior: Kanazawa 2023, Eqs. 5.11-5.17.
//!
//! With z-scored regressors, `C` their correlation matrix and `b` the mean products with the
//! target, `beta' = (C + lambda I)^-1 (b + lambda (1 - alpha) beta'_source)`. One symmetric
//! eigendecomposition of `C` gives every (lambda, alpha); nothing is inverted.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{Metric, Moments};

/// Everything that one set of samples and one source need for all (lambda, alpha).
#[derive(Debug, Clone)]
pub struct RidgePath {
    metric: Metric,
    eigenvalues: DVector<f64>,
    eigenvectors: DMatrix<f64>,
    /// Per target: the data's and the source's part in the eigenbasis.
    data: Vec<DVector<f64>>,
    source: Vec<DVector<f64>>,
    target_variance: Vec<f64>,
    count: f64,
}

/// A point of the path: how strongly the source holds, and how much of it is replaced by zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RidgeChoice {
    /// Strength of the prior.
    pub lambda: f64,
    /// Share of the zero vector in the prior.
    pub alpha: f64,
}

impl RidgePath {
    /// Decomposes the statistics once; `source[t]` are the prior coefficients for target `t`, in
    /// the units of the regressors. A regressor that does not vary keeps its source value.
    pub fn new(moments: &Moments, source: &[Vec<f64>]) -> Self {
        Self::shrunken(moments, source, &vec![1.0; moments.regressors()])
    }

    /// The same with a prior whose precision is `shrinkage[j]` times the common one for regressor
    /// `j`: each is measured not by its standard deviation but by that times the root of its
    /// shrinkage.
    pub fn shrunken(moments: &Moments, source: &[Vec<f64>], shrinkage: &[f64]) -> Self {
        Self::measured(moments, source, Metric::of_regressors(moments, shrinkage))
    }

    /// The same with any measure of the coefficients.
    pub fn measured(moments: &Moments, source: &[Vec<f64>], metric: Metric) -> Self {
        let SymmetricEigen { eigenvalues, eigenvectors } =
            SymmetricEigen::new(metric.products(moments));
        let targets = 0..moments.targets();
        let data = targets
            .clone()
            .map(|t| tr_mul(&eigenvectors, &metric.products_with_target(moments, t)))
            .collect();
        let source = source
            .iter()
            .map(|beta| tr_mul(&eigenvectors, &(metric.root() * DVector::from_column_slice(beta))));
        let source = source.collect();
        let target_variance = targets.map(|t| moments.target_variance(t)).collect();
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

    /// The coefficients of a target in the units of the regressors.
    pub fn solve(&self, target: usize, choice: RidgeChoice, source: &[f64]) -> Vec<f64> {
        let (from_data, from_source) = self.parts(target, choice.lambda);
        self.unscaled(&(from_data + from_source * (1.0 - choice.alpha)), source)
    }

    /// The two vectors of which every solution at `lambda` is `data + (1 - alpha) source`,
    /// standardised.
    fn parts(&self, target: usize, lambda: f64) -> (DVector<f64>, DVector<f64>) {
        let divide = |v: &DVector<f64>, by: f64| {
            v.zip_map(&self.eigenvalues, |x, d| by * x / (d + lambda).max(1e-300))
        };
        let data = &self.eigenvectors * divide(&self.data[target], 1.0);
        let source = &self.eigenvectors * divide(&self.source[target], lambda);
        (data, source)
    }

    fn unscaled(&self, beta: &DVector<f64>, source: &[f64]) -> Vec<f64> {
        let coefficients = self.metric.back() * beta;
        let one = |(j, kept): (usize, &f64)| {
            if self.metric.is_still(j) { *kept } else { coefficients[j] }
        };
        source.iter().enumerate().map(one).collect()
    }

    /// The alpha within a range that is best at `lambda` on other samples, and the mean squared
    /// error there; the error is that of the model without intercept, and quadratic in alpha, so
    /// that its minimum is at hand.
    pub fn best_alpha(
        &self,
        target: usize,
        lambda: f64,
        source: &[f64],
        validation: &Validation,
        alphas: (f64, f64),
    ) -> (f64, f64) {
        let (data, prior) = self.parts(target, lambda);
        let fixed = self.unscaled(&data, source);
        let zero = vec![0.0; source.len()];
        let along = self.unscaled(&prior, &zero);
        let (constant, linear, square) = validation.error_along(target, &fixed, &along);
        let stationary = if square > 0.0 { -linear / (2.0 * square) } else { 1.0 };
        let weight = stationary.clamp(1.0 - alphas.1, 1.0 - alphas.0);
        (1.0 - weight, constant + linear * weight + square * weight * weight)
    }

    /// Residual variance of a target at a solution, from the statistics alone; degrees of freedom
    /// as the ridge uses them.
    pub fn residual_variance(&self, target: usize, choice: RidgeChoice) -> f64 {
        let solution = |i: usize| {
            let pull = choice.lambda * (1.0 - choice.alpha) * self.source[target][i];
            (self.data[target][i] + pull) / (self.eigenvalues[i] + choice.lambda).max(1e-300)
        };
        let explained: f64 = (0..self.eigenvalues.len())
            .map(|i| solution(i) * (2.0 * self.data[target][i] - self.eigenvalues[i] * solution(i)))
            .sum();
        let freedom: f64 =
            self.eigenvalues.iter().map(|d| d / (d + choice.lambda).max(1e-300)).sum();
        let mean = (self.target_variance[target] - explained).max(0.0);
        mean * self.count / (self.count - freedom - 1.0).max(1.0)
    }

    /// Mean square of a target about its mean, or about zero where the statistics are.
    pub fn target_variance(&self, target: usize) -> f64 {
        self.target_variance[target]
    }

    /// How badly a strength of the prior explains a target: twice the negative logarithm of the
    /// marginal likelihood by the number of samples, with the residual variance at its best and
    /// without what does not depend on lambda. Where the prior has the variance `s^2/(n lambda)`
    /// about the source, the samples less what the source explains are normal with eigenvalues `s^2
    /// (d + lambda)/lambda` in the eigenbasis (MacKay 1992, Neural Computation 4, 415-447, section
    /// 3).
    pub fn misfit(&self, target: usize, lambda: f64) -> f64 {
        let (data, source, d) = (&self.data[target], &self.source[target], &self.eigenvalues);
        let terms = || data.iter().zip(source).zip(d).map(|((z, s), d)| (*z, *s, *d));
        let unexplained = self.target_variance[target]
            + terms().map(|(z, s, d)| s * (d * s - 2.0 * z)).sum::<f64>();
        let gained: f64 = terms().map(|(z, s, d)| (z - d * s).powi(2) / (d + lambda)).sum();
        let width: f64 = d.iter().map(|d| (1.0 + d / lambda).ln()).sum();
        (unexplained - gained).max(1e-300).ln() + width / self.count.max(1.0)
    }

    /// Posterior standard deviations of the coefficients at residual variance 1, and the prior's,
    /// both in the units of the regressors.
    pub fn deviations(&self, lambda: f64) -> Vec<(f64, f64)> {
        let weights = self.eigenvalues.map(|d| 1.0 / (self.count * (d + lambda).max(1e-300)));
        let directions = self.metric.back() * &self.eigenvectors;
        let posterior = |j: usize| {
            directions.row(j).iter().zip(weights.iter()).map(|(v, w)| v * v * w).sum::<f64>()
        };
        let prior = 1.0 / (self.count * lambda.max(1e-300));
        let held = |j: usize| prior * self.metric.back().row(j).norm_squared();
        (0..self.metric.size()).map(|j| (posterior(j).sqrt(), held(j).sqrt())).collect()
    }

    /// Half the second derivative of what a solution at `lambda` makes least, the sum of squares
    /// and of the prior's pull, in the units of the regressors; 1 for a regressor that does not
    /// vary.
    pub fn curvature(&self, lambda: f64) -> DMatrix<f64> {
        let weights = self.eigenvalues.map(|d| self.count * (d + lambda));
        let standard =
            &self.eigenvectors * DMatrix::from_diagonal(&weights) * self.eigenvectors.transpose();
        let own = self.metric.root().transpose() * standard * self.metric.root();
        let still = |j: usize| self.metric.is_still(j);
        DMatrix::from_fn(self.metric.size(), self.metric.size(), |i, j| {
            match still(i) || still(j) {
                true => f64::from(u8::from(i == j)),
                false => own[(i, j)],
            }
        })
    }

    /// Largest eigenvalue of the correlation matrix over the smallest of those that belong to
    /// varying regressors.
    pub fn condition_number(&self) -> f64 {
        let still = (0..self.metric.size()).filter(|j| self.metric.is_still(*j)).count();
        let mut values: Vec<f64> = self.eigenvalues.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        let smallest = values.get(still).copied().unwrap_or(0.0);
        values.last().map_or(1.0, |largest| largest / smallest.max(largest * f64::EPSILON))
    }

    /// Groups of regressors that the samples cannot tell apart: those that share an eigenvector
    /// whose eigenvalue is below `tolerance` of the largest.
    pub fn collinear_groups(&self, tolerance: f64) -> Vec<Vec<usize>> {
        let largest = self.eigenvalues.max();
        let small =
            (0..self.eigenvalues.len()).filter(|&i| self.eigenvalues[i] < tolerance * largest);
        let members = |i: usize| -> Vec<usize> {
            let moved = self.metric.back() * self.eigenvectors.column(i);
            let moved = DVector::from_fn(moved.len(), |j, _| {
                moved[j] * self.metric.root().column(j).norm()
            })
            .normalize();
            (0..moved.len()).filter(|&j| moved[j].abs() > 0.3).collect()
        };
        let mut groups: Vec<Vec<usize>> =
            small.map(members).filter(|group| group.len() > 1).collect();
        groups.sort();
        groups.dedup();
        groups
    }
}

/// `V' x`, a column at a time: nalgebra's own transposed product is far slower.
fn tr_mul(matrix: &DMatrix<f64>, vector: &DVector<f64>) -> DVector<f64> {
    DVector::from_iterator(matrix.ncols(), matrix.column_iter().map(|column| column.dot(vector)))
}

/// Samples on which solutions are judged, prepared once.
#[derive(Debug, Clone)]
pub struct Validation {
    raw: DMatrix<f64>,
    regressors: usize,
}

impl Validation {
    /// From their statistics.
    pub fn new(moments: &Moments) -> Self {
        Self { raw: moments.raw_products(), regressors: moments.regressors() }
    }

    /// Mean squared error of `fixed + w along` as `(constant, linear, square)` in `w`.
    fn error_along(&self, target: usize, fixed: &[f64], along: &[f64]) -> (f64, f64, f64) {
        let (p, t) = (self.regressors, self.regressors + target);
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
        (self.raw[(t, t)] - 2.0 * data + own, 2.0 * (cross - shift), square)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn samples() -> Vec<Vec<f64>> {
        let x: Vec<f64> = (0..400).map(|k| (0.11 * f64::from(k)).sin()).collect();
        let z: Vec<f64> = (0..400).map(|k| 3.0 + (0.07 * f64::from(k)).cos()).collect();
        let y = x.iter().zip(&z).map(|(x, z)| 2.0 * x - 0.5 * z).collect();
        vec![x, z, y]
    }

    #[test]
    fn known_coefficients_are_recovered_and_the_source_holds_when_told_to() {
        let path = RidgePath::new(&Moments::of_columns(&samples(), 2), &[vec![1.0, 1.0]]);
        let at =
            |lambda: f64, alpha: f64| path.solve(0, RidgeChoice { lambda, alpha }, &[1.0, 1.0]);
        let free = at(1e-12, 0.0);
        assert!((free[0] - 2.0).abs() < 1e-9 && (free[1] + 0.5).abs() < 1e-9);
        let held = at(1e9, 0.0);
        assert!((held[0] - 1.0).abs() < 1e-6 && (held[1] - 1.0).abs() < 1e-6);
        assert!(at(1e9, 1.0)[0].abs() < 1e-6);
    }

    #[test]
    fn the_closed_form_solves_the_normal_equations() {
        let moments = Moments::of_columns(&samples(), 2);
        let (lambda, alpha, source) = (0.3, 0.2, [1.5, -1.0]);
        let beta = RidgePath::new(&moments, &[source.to_vec()]).solve(
            0,
            RidgeChoice { lambda, alpha },
            &source,
        );
        for i in 0..2 {
            let sigma = moments.variance(i).sqrt();
            let left: f64 = (0..2).map(|j| moments.covariance(i, j) * beta[j]).sum::<f64>() / sigma
                + lambda * beta[i] * sigma;
            let right = moments.covariance_with_target(i, 0) / sigma
                + lambda * (1.0 - alpha) * source[i] * sigma;
            assert!((left - right).abs() < 1e-12);
        }
    }

    #[test]
    fn shrinkage_makes_a_prior_more_precise() {
        let moments = Moments::of_columns(&samples(), 2);
        let (lambda, source, shrinkage) = (0.3, [1.5, -1.0], [1.0, 9.0]);
        let path = RidgePath::shrunken(&moments, &[source.to_vec()], &shrinkage);
        let beta = path.solve(0, RidgeChoice { lambda, alpha: 0.0 }, &source);
        for i in 0..2 {
            let precision = lambda * shrinkage[i] * moments.variance(i);
            let left: f64 = (0..2).map(|j| moments.covariance(i, j) * beta[j]).sum::<f64>()
                + precision * beta[i];
            assert!(
                (left - moments.covariance_with_target(i, 0) - precision * source[i]).abs() < 1e-12
            );
        }
        let ratio = |deviations: Vec<(f64, f64)>| deviations[1].1;
        let plain = RidgePath::new(&moments, &[source.to_vec()]);
        assert!(
            (ratio(plain.deviations(lambda)) / ratio(path.deviations(lambda)) - 3.0).abs() < 1e-12
        );
    }

    /// Against the density of the samples themselves, a normal distribution of as many dimensions
    /// as there are samples.
    #[test]
    fn the_misfit_is_that_of_the_marginal_likelihood() {
        let mut columns: Vec<Vec<f64>> =
            samples().iter().map(|column| column[..40].to_vec()).collect();
        columns[2].iter_mut().enumerate().for_each(|(k, y)| *y += 0.3 * (5.1 * k as f64).sin());
        let source = [1.5, -1.0];
        let path = RidgePath::new(&Moments::of_columns(&columns, 2), &[source.to_vec()]);
        let centred = columns.iter().map(|column| {
            let column = DVector::from_vec(column.clone());
            let mean = column.mean();
            column.add_scalar(-mean)
        });
        let centred: Vec<DVector<f64>> = centred.collect();
        let unexplained = &centred[2] - &centred[0] * source[0] - &centred[1] * source[1];
        let direct = |lambda: f64| {
            let spread = |x: &DVector<f64>| x * x.transpose() / (x.norm_squared() * lambda);
            let covariance = DMatrix::identity(40, 40) + spread(&centred[0]) + spread(&centred[1]);
            let variance =
                unexplained.dot(&covariance.clone().lu().solve(&unexplained).unwrap()) / 40.0;
            variance.ln() + covariance.determinant().ln() / 40.0
        };
        for lambda in [1e-4, 1e-2, 1.0] {
            assert!((path.misfit(0, lambda) - direct(lambda)).abs() < 1e-9, "{lambda}");
        }
    }

    #[test]
    fn the_best_alpha_beats_its_neighbours() {
        let moments = Moments::of_columns(&samples(), 2);
        let source = [2.5, -0.7];
        let path = RidgePath::new(&moments, &[source.to_vec()]);
        let validation = Validation::new(&moments);
        let (alpha, error) = path.best_alpha(0, 1.0, &source, &validation, (0.0, 1.0));
        for other in [alpha - 0.05, alpha + 0.05] {
            let beta = path.solve(0, RidgeChoice { lambda: 1.0, alpha: other }, &source);
            let columns = samples();
            let mse = (0..400)
                .map(|k| {
                    (columns[2][k] - beta[0] * columns[0][k] - beta[1] * columns[1][k]).powi(2)
                })
                .sum::<f64>()
                / 400.0;
            assert!(mse > error);
        }
    }
}
