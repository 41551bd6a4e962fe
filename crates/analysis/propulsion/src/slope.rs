//! The derivative of a model's surge force by the speed, at its approach.

use std::collections::BTreeMap;

use sistership_model::{Law, Model};
use sistership_simulation::equations::PlantError;

use crate::straight_surge::StraightSurge;

/// A figure and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UncertainValue {
    pub mean: f64,
    pub deviation: f64,
}

/// Half of the change of speed over which the derivative is taken, as a share of the speed.
const STEP: f64 = 0.05;

/// Returns the derivative of the surge force by the speed, N s/m, with its deviation by the model's
/// posterior; `None` without one.
pub(crate) fn surge_derivative(
    model: &Model,
    law: &Law,
    [speed_m_s, n_rps]: [f64; 2],
) -> Option<UncertainValue> {
    let posterior = model.valid_posterior()?;
    let slopes = coefficient_derivatives(model, law, [speed_m_s, n_rps]).ok()?;
    let of = |name: &String| slopes.by_name.get(name).copied().unwrap_or(0.0);
    let coefficients = model.coefficients.iter();
    let mean = slopes.rest + coefficients.map(|(name, c)| c.value * of(name)).sum::<f64>();
    let root = posterior.covariance_root().ok()?;
    // With `L` the root of the covariance and `g` the derivatives by coefficient the variance is
    // `|L' g|^2`.
    let along = |column: usize| {
        let rows = posterior.names.iter().zip(&root);
        rows.map(|(name, row)| of(name) * row.get(column).copied().unwrap_or(0.0)).sum::<f64>()
    };
    let variance = (0..posterior.names.len()).map(|column| along(column).powi(2)).sum::<f64>();
    Some(UncertainValue { mean, deviation: variance.sqrt() })
}

/// Derivatives per unit of each coefficient, and of the rest.
struct CoefficientDerivatives {
    by_name: BTreeMap<String, f64>,
    rest: f64,
}

fn coefficient_derivatives(
    model: &Model,
    law: &Law,
    [speed, n_rps]: [f64; 2],
) -> Result<CoefficientDerivatives, PlantError> {
    let surge = StraightSurge::new(model, law, n_rps)?;
    let (low, high) = (surge.terms((1.0 - STEP) * speed), surge.terms((1.0 + STEP) * speed));
    let by: Vec<f64> =
        low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * STEP * speed)).collect();
    let rest = by.last().copied().unwrap_or(0.0);
    let by_name = surge.coefficients.into_iter().zip(by).collect();
    Ok(CoefficientDerivatives { by_name, rest })
}
