//! Information of a trial on possible changes, with all that is present with any of them integrated
//! out.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::super::coefficient_prior::CoefficientPrior;
use super::super::evidence::{MarginalInformation, NormalPrior, not_positive_error};
use sistership_filtering::GramMatrix;
use sistership_identification::refine::RefineError;

/// Coefficients and accepted effects of a trial, whose information is factorised once for all
/// changes.
pub(super) struct ReducedTrial {
    /// Lower factor `L` of their information with their priors.
    factor: DMatrix<f64>,
    /// `L^-1 b`, with the right side `b`.
    solved: DVector<f64>,
}

impl ReducedTrial {
    /// Factorises the products of residual, coefficients and accepted effects; these have the
    /// priors `taken`.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn new(
        gram: &GramMatrix,
        fixed: &CoefficientPrior,
        taken: &[NormalPrior],
    ) -> Result<Self, RefineError> {
        let c = fixed.weighted_mean.len();
        let size = c + taken.len();
        let mut information = gram.products.view((1, 1), (size, size)).into_owned();
        let mut right = gram.products.view((1, 0), (size, 1)).column(0).into_owned();
        let mut known = information.view_mut((0, 0), (c, c));
        known += &fixed.information;
        let mut expected = right.rows_mut(0, c);
        expected += &fixed.weighted_mean;
        for (place, prior) in taken.iter().enumerate() {
            let precision = prior.deviation.powi(-2);
            information[(c + place, c + place)] += precision;
            right[c + place] += precision * prior.mean;
        }
        let factor = Cholesky::new(information).ok_or_else(not_positive_error)?.unpack();
        let solved = factor.solve_lower_triangular(&right).ok_or_else(not_positive_error)?;
        Ok(Self { factor, solved })
    }

    /// Returns the information on columns by their products: with residual, coefficients and
    /// accepted effects (`cross`), and among themselves.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn information(
        &self,
        cross: &DMatrix<f64>,
        own: &DMatrix<f64>,
    ) -> Result<MarginalInformation, RefineError> {
        // With H = L^-1 G_ka: the Schur complement G_aa - H' H.
        let known = self.solve_cross(cross)?;
        Ok(MarginalInformation {
            deviance: 0.0,
            information: own - known.tr_mul(&known),
            right: cross.row(0).transpose() - known.tr_mul(&self.solved),
            answers: DMatrix::zeros(0, 0),
            shift: DVector::zeros(0),
        })
    }

    /// Returns coefficients and accepted effects where a change has a size.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn known_parameters(
        &self,
        cross: &DMatrix<f64>,
        size: &DVector<f64>,
    ) -> Result<DVector<f64>, RefineError> {
        let left = &self.solved - self.solve_cross(cross)? * size;
        self.factor.tr_solve_lower_triangular(&left).ok_or_else(not_positive_error)
    }

    fn solve_cross(&self, cross: &DMatrix<f64>) -> Result<DMatrix<f64>, RefineError> {
        let known = cross.rows(1, cross.nrows() - 1).into_owned();
        self.factor.solve_lower_triangular(&known).ok_or_else(not_positive_error)
    }
}
