//! Joint errors of coefficients.

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::posterior::Posterior;

/// Joint errors of coefficients, in their units.
#[derive(Debug, Clone)]
pub(super) struct CoefficientErrors {
    /// The coefficients in the order of the matrices.
    pub names: Vec<String>,
    /// Covariance of the estimates.
    pub covariance: DMatrix<f64>,
    /// Covariance of the source's coefficients about the true ones.
    pub source: DMatrix<f64>,
    /// Covariance of the estimates' errors with the source's.
    pub cross: DMatrix<f64>,
}

impl CoefficientErrors {
    /// Returns the errors of the coefficients `names`, in that order; `None` if one is missing.
    pub fn in_order(&self, names: &[String]) -> Option<Self> {
        let place = |name: &String| self.names.iter().position(|own| own == name);
        let places: Vec<usize> = names.iter().map(place).collect::<Option<_>>()?;
        let of = |matrix: &DMatrix<f64>| matrix.select_rows(&places).select_columns(&places);
        let (covariance, source, cross) = (of(&self.covariance), of(&self.source), of(&self.cross));
        Some(Self { names: names.to_vec(), covariance, source, cross })
    }

    /// Returns the errors with unknowns after the others that are the source's, each with the
    /// variance of its prior.
    pub fn with_prior_variances(mut self, variances: &[(String, f64)]) -> Self {
        let (first, size) = (self.names.len(), self.names.len() + variances.len());
        for matrix in [&mut self.covariance, &mut self.source, &mut self.cross] {
            *matrix = matrix.clone().resize(size, size, 0.0);
            (first..).zip(variances).for_each(|(k, (_, variance))| matrix[(k, k)] = *variance);
        }
        self.names.extend(variances.iter().map(|(name, _)| name.clone()));
        self
    }

    /// Returns the errors of quantities that change by a slope with each unknown.
    pub fn rescaled(mut self, slopes: &DVector<f64>) -> Self {
        let scale = DMatrix::from_diagonal(slopes);
        for matrix in [&mut self.covariance, &mut self.source, &mut self.cross] {
            *matrix = &scale * &*matrix * &scale;
        }
        self
    }

    /// Returns the errors as a posterior of a model; `None` if the covariance has no Cholesky root.
    pub fn to_posterior(&self, model: &Model) -> Option<Posterior> {
        let deviations = self.covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let inverse = deviations.map(reciprocal_or_zero);
        let size = self.names.len();
        // A coefficient without variance is uncorrelated with all others.
        let entry = |i: usize, j: usize| {
            if i == j { 1.0 } else { self.covariance[(i, j)] * inverse[i] * inverse[j] }
        };
        let correlation = DMatrix::from_fn(size, size, entry);
        let rooted = |slack: &f64| {
            (&correlation * (1.0 - slack) + DMatrix::identity(size, size) * *slack).cholesky()
        };
        // Rounding makes the matrix of almost collinear coefficients indefinite; a small multiple
        // of the identity makes it positive definite.
        let root = SLACK.iter().find_map(rooted)?.unpack();
        let names = self.names.clone();
        let value = |name: &String| model.named_value(name).map_or(0.0, |quantity| quantity.value);
        let values = names.iter().map(value).collect();
        let root_correlation = Posterior::format_rows(size, &|i, j| root[(i, j)]);
        Some(Posterior {
            names,
            values,
            deviations: deviations.iter().copied().collect(),
            root_correlation,
        })
    }
}

/// Weights of the identity that are tried in turn until the correlation matrix has a Cholesky root.
const SLACK: [f64; 4] = [0.0, 1e-10, 1e-8, 1e-6];

/// Reciprocal of a scale; 0 for a scale of 0.
fn reciprocal_or_zero(scale: f64) -> f64 {
    if scale > 0.0 { 1.0 / scale } else { 0.0 }
}
