//! The derivative of a model's surge force by the speed, at its approach.

use std::collections::BTreeMap;

use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model};
use sistership_simulation::equations::{EquationLowering, EquationsOfMotion, PlantError};

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
    let equations = EquationsOfMotion::from_foundation(model, law)?;
    let names = equations.tape_input_names();
    let mut lowering = EquationLowering::new(&equations, &names);
    let coefficients: Vec<&String> = equations.axis_coefficients(Axis::X).collect();
    for name in &coefficients {
        lowering.add_output(&equations.scaled_regressor(name)?)?;
    }
    // The rest is the last output, after the regressors of the coefficients.
    lowering.add_output(&equations.law().axes[&Axis::X].rest)?;
    let tape = lowering.finish();
    let defaults: BTreeMap<String, Option<f64>> = equations.law_inputs().into_iter().collect();
    let given = |name: &String, u: f64| match name.as_str() {
        "u" => u,
        "n" => n_rps,
        name => defaults.get(name).copied().flatten().unwrap_or(0.0),
    };
    let at =
        |u: f64| tape.evaluate_point(&names.iter().map(|name| given(name, u)).collect::<Vec<_>>());
    let (low, high) = (at((1.0 - STEP) * speed), at((1.0 + STEP) * speed));
    let by: Vec<f64> =
        low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * STEP * speed)).collect();
    let rest = by.last().copied().unwrap_or(0.0);
    let by_name = coefficients.into_iter().cloned().zip(by).collect();
    Ok(CoefficientDerivatives { by_name, rest })
}
