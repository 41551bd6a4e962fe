//! A fit by the trajectory form, and the joint errors of its coefficients.
//!
//! With `H` the Hessian, `g` the gradient of the residuals, and `W` and `L` as in [the
//! form](super), the error is `H^-1 (g + mu W (c_weak - c) + mu/(1 + mu) L (c_source - c))`: the
//! scatter of the segments' gradients, within which residuals may depend on each other (Huber 1967,
//! Proc. Fifth Berkeley Symposium 1, 221-233), and the errors of the means of the prior.

use nalgebra::{DMatrix, DVector};

use super::super::candidate::CandidateSolution;
use super::super::errors::CoefficientErrors;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::ridge::{CoefficientFit, FittedCoefficient, RidgeChoices};
use super::super::variant::TermVariant;
use super::parameters::BoundedParameter;
use super::prior::{WeakFormPrior, source_pull};
use super::solve::PenalisedEquations;

/// A fit, with the data of its errors.
pub(super) struct TrajectoryFit {
    /// The weak form from which it started: place of its variant, and choices.
    pub variant: usize,
    pub choices: RidgeChoices,
    /// The coefficients in the order of the normal equations.
    pub(super) names: Vec<String>,
    /// Parameters, whose unknowns follow.
    pub(super) parameters: Vec<BoundedParameter>,
    /// Derivatives of coefficients and parameters by the unknowns.
    pub(super) slopes: DVector<f64>,
    pub(super) at: DVector<f64>,
    pub(super) held: PenalisedEquations,
    /// Gradients of the residuals by segment.
    pub(super) gradients: Vec<DVector<f64>>,
    /// Cost of the residuals, summed.
    pub(super) cost: f64,
    pub(super) count: f64,
    pub(super) prior: WeakFormPrior,
    pub(super) pull: f64,
}

impl CandidateSolution for TrajectoryFit {
    fn fit(&self, _: &[TermVariant]) -> Result<Option<CoefficientFit>, RefineError> {
        Ok(Some(self.coefficient_fit()))
    }

    fn coefficient_errors(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
    ) -> Result<Option<CoefficientErrors>, RefineError> {
        let weak = variants[self.variant].ridge_errors(&problem.training, &self.choices)?;
        Ok(weak.and_then(|weak| self.joint_errors(&weak)))
    }

    fn effective_count(&self, _: &[TermVariant]) -> Result<Option<f64>, RefineError> {
        Ok(self.trials_share())
    }
}

impl TrajectoryFit {
    /// Trace of the share of the trials in the Hessian; the rest is that of the source.
    fn trials_share(&self) -> Option<f64> {
        let strength = self.prior.source_strength(self.pull);
        let of_source = (self.held.inverse_hessian()? * &self.prior.of_source).trace() * strength;
        Some((self.at.len() as f64 - of_source).max(0.0))
    }

    /// The coefficients, without their errors.
    fn coefficient_fit(&self) -> CoefficientFit {
        let deviations = self.prior.coefficient_deviations(self.pull);
        let one = |(k, name): (usize, &String)| {
            // The prior counts in units of the residuals' mean square.
            let prior_deviation = deviations[k] * (self.cost / self.count.max(1.0)).sqrt();
            (
                name.clone(),
                FittedCoefficient { value: self.at[k], standard_error: 0.0, prior_deviation },
            )
        };
        let coefficients = self.names.iter().enumerate().map(one).collect();
        let own = self.parameters.iter().zip(self.at.iter().skip(self.names.len()));
        let parameter = |(one, unknown): (&BoundedParameter, &f64)| {
            let (value, prior_deviation) = (one.value(*unknown), one.deviation);
            (one.name.clone(), FittedCoefficient { value, standard_error: 0.0, prior_deviation })
        };
        CoefficientFit {
            coefficients,
            parameters: own.map(parameter).collect(),
            condition_number: self.held.condition_number(),
            collinear_groups: Vec::new(),
            errors: None,
        }
    }

    /// Joint errors of the coefficients; `weak` are those of the weak form, in any order. `None` if
    /// a matrix cannot be inverted or a coefficient is missing.
    fn joint_errors(&self, weak: &CoefficientErrors) -> Option<CoefficientErrors> {
        let Self { names, prior, pull, .. } = self;
        let inverse = self.held.inverse_hessian()?;
        let weak = weak.in_order(names)?.with_prior_variances(&self.parameter_variances());
        let to_weak = &prior.hessian * *pull;
        let to_source = &prior.of_source * source_pull(*pull);
        // The errors of weak form and source are correlated, since the source is the weak form's
        // prior.
        let both = &to_weak * &weak.cross * &to_source;
        let middle = gradient_scatter(&self.gradients, self.count, self.at.len())
            + &to_weak * &weak.covariance * &to_weak
            + &to_source * &weak.source * &to_source
            + &both
            + both.transpose();
        let cross = &inverse * (&to_weak * &weak.cross + to_source * &weak.source);
        let of_unknowns = CoefficientErrors {
            names: weak.names,
            covariance: &inverse * middle * &inverse,
            source: weak.source,
            cross,
        };
        Some(of_unknowns.rescaled(&self.slopes))
    }

    /// Variances of the priors of the unknowns of parameters, by name.
    fn parameter_variances(&self) -> Vec<(String, f64)> {
        let one = |own: &BoundedParameter| (own.name.clone(), own.unknown_deviation().powi(2));
        self.parameters.iter().map(one).collect()
    }
}

/// Covariance of the mean gradient from the gradients of the segments, with the correction `n/(n -
/// 1)` for their number.
fn gradient_scatter(gradients: &[DVector<f64>], count: f64, size: usize) -> DMatrix<f64> {
    let segments = gradients.len() as f64;
    let mut sum = DMatrix::zeros(size, size);
    gradients.iter().for_each(|gradient| sum.ger(1.0, gradient, gradient, 1.0));
    sum * (segments / (segments - 1.0).max(1.0) / count.max(1.0).powi(2))
}
