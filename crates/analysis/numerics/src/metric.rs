//! Metrics by which a prior measures coefficients.

use nalgebra::{DMatrix, DVector};

use super::RegressionMoments;

/// Root of a prior's precision at strength 1: in the coordinates `z = root b` of coefficients `b`,
/// the prior is isotropic.
#[derive(Debug, Clone)]
pub struct PriorMetric {
    root: DMatrix<f64>,
    /// Inverse of the root; zero for coefficients without variation.
    back: DMatrix<f64>,
    /// True for coefficients that the data cannot change: their regressor does not vary.
    still: Vec<bool>,
}

impl PriorMetric {
    /// Metric of each coefficient by the standard deviation of its regressor times the root of
    /// `shrinkage`, the precision of its prior relative to the common one (Kanazawa 2023, Eq. 5.11,
    /// with every shrinkage 1).
    pub fn of_regressors(moments: &RegressionMoments, shrinkage: &[f64]) -> Self {
        let p = moments.regressors();
        let deviation = |j: usize| moments.regressor_variance(j).sqrt();
        let still: Vec<bool> =
            // Relative to the mean: rounding leaves a small deviation to a constant.
            (0..p).map(|j| deviation(j) / moments.regressor_mean(j).abs().max(1e-300) <= 1e-10).collect();
        let scales = DVector::from_fn(p, |j, _| {
            if still[j] { 0.0 } else { (moments.regressor_variance(j) * shrinkage[j]).sqrt() }
        });
        let inverse = scales.map(|scale| if scale > 0.0 { 1.0 / scale } else { 0.0 });
        Self {
            root: DMatrix::from_diagonal(&scales),
            back: DMatrix::from_diagonal(&inverse),
            still,
        }
    }

    /// Metric of all coefficients jointly by a precision matrix; a coefficient with a precision of
    /// zero is fixed. Returns `None` if the matrix is not positive definite.
    pub fn of_precision(precision: &DMatrix<f64>) -> Option<Self> {
        let p = precision.nrows();
        let still: Vec<bool> = precision.diagonal().iter().map(|own| *own == 0.0).collect();
        let scales = precision.diagonal().map(f64::sqrt);
        let inverse = scales.map(|scale| if scale > 0.0 { 1.0 / scale } else { 0.0 });
        let entry = |i: usize, j: usize| {
            if i == j { 1.0 } else { precision[(i, j)] * inverse[i] * inverse[j] }
        };
        // Decomposed with a unit diagonal, as precisions differ by orders of magnitude.
        let unit = DMatrix::from_fn(p, p, entry).cholesky()?.unpack().transpose();
        let back = DMatrix::from_diagonal(&inverse)
            * unit.solve_upper_triangular(&DMatrix::identity(p, p))?;
        Some(Self { root: unit * DMatrix::from_diagonal(&scales), back, still })
    }

    /// Number of coefficients.
    pub fn coefficient_count(&self) -> usize {
        self.still.len()
    }

    /// True if the data cannot change a coefficient.
    pub fn is_fixed(&self, coefficient: usize) -> bool {
        self.still[coefficient]
    }

    /// Matrix from coefficients to coordinates.
    pub fn root_matrix(&self) -> &DMatrix<f64> {
        &self.root
    }

    /// Matrix from coordinates to coefficients.
    pub fn inverse_root(&self) -> &DMatrix<f64> {
        &self.back
    }

    /// Mean products of the regressors, transformed to the coordinates.
    pub fn regressor_products(&self, moments: &RegressionMoments) -> DMatrix<f64> {
        let p = self.coefficient_count();
        let own = DMatrix::from_fn(p, p, |i, j| moments.regressor_covariance(i, j));
        self.back.transpose() * own * &self.back
    }

    /// Mean products of the transformed regressors with a target.
    pub fn products_with_target(&self, moments: &RegressionMoments, target: usize) -> DVector<f64> {
        let own = DVector::from_fn(self.coefficient_count(), |j, _| {
            moments.covariance_with_target(j, target)
        });
        self.back.tr_mul(&own)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn moments() -> RegressionMoments {
        let x: Vec<f64> = (0..400).map(|k| (0.11 * f64::from(k)).sin()).collect();
        let z: Vec<f64> = (0..400).map(|k| 3.0 + 1e-3 * (0.07 * f64::from(k)).cos()).collect();
        let y = x.iter().zip(&z).map(|(x, z)| 2.0 * x - 0.5 * z).collect();
        RegressionMoments::from_columns(&[x, z, vec![5.0; 400], y], 3)
    }

    #[test]
    fn regressors_in_their_own_deviations_have_ones_on_the_diagonal_and_what_is_still_has_none() {
        let metric = PriorMetric::of_regressors(&moments(), &[1.0, 4.0, 1.0]);
        let products = metric.regressor_products(&moments());
        assert!(
            (products[(0, 0)] - 1.0).abs() < 1e-12
                && (products[(1, 1)] - 0.25).abs() < 1e-12
                && products[(2, 2)] == 0.0
        );
        assert!(metric.is_fixed(2) && !metric.is_fixed(0));
    }

    #[test]
    fn what_varies_by_less_than_rounding_by_its_mean_is_still() {
        let column = |mean: f64, size: f64| -> Vec<f64> {
            (0..400).map(|k| mean + size * (0.11 * f64::from(k)).sin()).collect()
        };
        let columns = [column(1e6, 3e-6), column(1e6, 1e-2), column(0.0, 1e-12), vec![0.0; 400]];
        let metric =
            PriorMetric::of_regressors(&RegressionMoments::from_columns(&columns, 3), &[1.0; 3]);
        assert!(metric.is_fixed(0) && !metric.is_fixed(1) && !metric.is_fixed(2));
        assert_eq!((metric.root_matrix()[(0, 0)], metric.inverse_root()[(0, 0)]), (0.0, 0.0));
    }

    #[test]
    fn a_precision_has_its_root_and_its_inverse() {
        let precision = DMatrix::from_row_slice(2, 2, &[4e8, 3e3, 3e3, 0.09]);
        let metric = PriorMetric::of_precision(&precision).unwrap();
        let again = metric.root_matrix().transpose() * metric.root_matrix();
        assert!((0..4).all(|k| (again[k] - precision[k]).abs() < 1e-9 * precision[k]));
        let one = metric.root_matrix() * metric.inverse_root();
        assert!((one - DMatrix::identity(2, 2)).abs().max() < 1e-9);
        let with_none =
            PriorMetric::of_precision(&DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0]))
                .unwrap();
        assert!(
            with_none.is_fixed(1)
                && with_none.inverse_root()[(0, 0)] == 0.5
                && with_none.inverse_root()[(1, 1)] == 0.0
        );
        assert!(
            PriorMetric::of_precision(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]))
                .is_none()
        );
    }
}
