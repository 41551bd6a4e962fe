//! Prior of the coefficients, in the information form of a normal distribution.

use nalgebra::{Cholesky, DMatrix, DVector};

use sistership_filtering::{NuisanceColumn, NuisanceKind};

/// Prior of the coefficients before these trials: `information`, and `information * mean`, by
/// column.
#[derive(Debug, Clone)]
pub struct CoefficientPrior {
    /// Information matrix, coefficients by coefficients.
    pub information: DMatrix<f64>,
    /// Information times the expected change.
    pub weighted_mean: DVector<f64>,
}

impl CoefficientPrior {
    /// Expected change of the coefficients; `None` where the information is not positive.
    pub fn expected_change(&self) -> Option<DVector<f64>> {
        Some(Cholesky::new(self.information.clone())?.solve(&self.weighted_mean))
    }

    /// Expected change of the columns that a law can include: all but masses, which are assumed to
    /// be right.
    pub fn expected_shift(&self, nuisance: &[NuisanceColumn]) -> Option<Vec<f64>> {
        let free: Vec<usize> = (0..nuisance.len())
            .filter(|&place| !matches!(nuisance[place].kind, NuisanceKind::Mass(..)))
            .collect();
        // Rows and columns of masses are removed: this conditions on no change of them.
        let information =
            DMatrix::from_fn(free.len(), free.len(), |i, j| self.information[(free[i], free[j])]);
        let weighted_mean = DVector::from_fn(free.len(), |i, _| self.weighted_mean[free[i]]);
        let mean = Self { information, weighted_mean }.expected_change()?;
        let mut shift = vec![0.0; nuisance.len()];
        free.iter().zip(mean.iter()).for_each(|(&place, value)| shift[place] = *value);
        Some(shift)
    }

    /// Prior of the changes relative to a model that has been moved by `shift` already.
    pub fn relative_to(mut self, shift: &[f64]) -> Self {
        self.weighted_mean -= &self.information * DVector::from_column_slice(shift);
        self
    }
}
