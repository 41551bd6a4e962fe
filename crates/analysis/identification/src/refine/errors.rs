//! Joint errors of coefficients.

use nalgebra::DMatrix;
use sistership_model::Model;
use sistership_model::posterior::Posterior;

/// Joint errors of coefficients, in their units.
#[derive(Debug, Clone)]
pub(super) struct CoefficientErrors {
    /// The coefficients in the order of the matrices.
    pub names: Vec<String>,
    /// Covariance of the estimates.
    pub covariance: DMatrix<f64>,
    /// Covariance of the source about the truth.
    pub source: DMatrix<f64>,
    /// Covariance of the estimates' errors with the source's.
    pub cross: DMatrix<f64>,
}

impl CoefficientErrors {
    /// The same for coefficients in another order; none where one is missing.
    pub fn ordered(&self, names: &[String]) -> Option<Self> {
        let place = |name: &String| self.names.iter().position(|own| own == name);
        let places: Vec<usize> = names.iter().map(place).collect::<Option<_>>()?;
        let of = |matrix: &DMatrix<f64>| matrix.select_rows(&places).select_columns(&places);
        let (covariance, source, cross) = (of(&self.covariance), of(&self.source), of(&self.cross));
        Some(Self { names: names.to_vec(), covariance, source, cross })
    }

    /// As a model keeps them; none where the covariance has no root.
    pub fn posterior(&self, model: &Model) -> Option<Posterior> {
        let deviations = self.covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let inverse = deviations.map(reciprocal);
        let size = self.names.len();
        let entry = |i: usize, j: usize| {
            if i == j { 1.0 } else { self.covariance[(i, j)] * inverse[i] * inverse[j] }
        };
        let correlation = DMatrix::from_fn(size, size, entry);
        let rooted = |slack: &f64| {
            (&correlation * (1.0 - slack) + DMatrix::identity(size, size) * *slack).cholesky()
        };
        let root = SLACK.iter().find_map(rooted)?.unpack();
        let names = self.names.clone();
        let values = names.iter().map(|name| model.coefficient(name)).collect();
        let root_correlation = Posterior::rows(size, &|i, j| root[(i, j)]);
        Some(Posterior {
            names,
            values,
            deviations: deviations.iter().copied().collect(),
            root_correlation,
        })
    }
}

/// Shares of independence that are tried until a correlation matrix has a root.
const SLACK: [f64; 4] = [0.0, 1e-10, 1e-8, 1e-6];

/// One over a scale; 0 for what does not vary.
fn reciprocal(scale: f64) -> f64 {
    if scale > 0.0 { 1.0 / scale } else { 0.0 }
}
