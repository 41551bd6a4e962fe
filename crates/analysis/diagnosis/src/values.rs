//! Parameters with their standard errors, and applied effects of a model.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use sistership_model::effect::{ActsOn, AppliedEffect};
use sistership_model::quantity::Quantity;
use sistership_model::{Model, particulars};

use super::outcome::ValueWithError;
use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;

/// Parameters of a candidate and quantities that follow from them, by the delta method;
/// `covariance` is that of its parameters.
pub(super) fn values_with_errors(
    candidate: &EffectCandidate,
    covariance: &DMatrix<f64>,
    model: &Model,
) -> BTreeMap<String, ValueWithError> {
    let names: Vec<&String> = candidate.form.parameters.keys().collect();
    let error = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    let own = names.iter().enumerate().map(|(i, name)| {
        ((*name).clone(), ValueWithError { value: candidate.at[i], se: error(i) })
    });
    let mut values: BTreeMap<String, ValueWithError> = own.collect();
    for name in candidate.form.reports.keys() {
        let at = |point: &[f64]| {
            let parameter =
                |known: &str| names.iter().position(|name| *name == known).map(|i| point[i]);
            candidate.form.report_value(name, &|known| {
                parameter(known)
                    .or_else(|| particulars::particular_value(&model.particulars, known))
            })
        };
        let Some(value) = at(&candidate.at) else { continue };
        // Central differences, with a step by the standard error.
        let slope = |i: usize| {
            // The floor is for parameters without uncertainty.
            let step = THRESHOLDS.effect.report_step * error(i).max(1e-12);
            let (mut above, mut below) = (candidate.at.clone(), candidate.at.clone());
            (above[i], below[i]) = (above[i] + step, below[i] - step);
            Some((at(&above)? - at(&below)?) / (2.0 * step))
        };
        let gradient =
            DVector::from_iterator(names.len(), (0..names.len()).map(|i| slope(i).unwrap_or(0.0)));
        let se = (gradient.transpose() * covariance * &gradient)[(0, 0)].max(0.0).sqrt();
        values.insert(name.clone(), ValueWithError { value: full_circle(name, value), se });
    }
    values
}

/// Quantities that are directions, deg.
const BEARINGS: [&str; 2] = ["towards_deg", "from_deg"];

/// Returns a direction from 0 to 360 deg, and any other quantity as it is.
fn full_circle(name: &str, value: f64) -> f64 {
    if BEARINGS.contains(&name) { value.rem_euclid(360.0) } else { value }
}

/// Part of a joint covariance that belongs to a candidate.
pub(super) fn own_covariance(
    candidates: &[EffectCandidate],
    place: usize,
    covariance: &DMatrix<f64>,
) -> DMatrix<f64> {
    let start: usize = candidates[..place].iter().map(|candidate| candidate.at.len()).sum();
    let size = candidates[place].at.len();
    covariance.view((start, start), (size, size)).into_owned()
}

/// Model with effects. Its coefficients stay unchanged: their shift on the new trials was fitted
/// together with terms that the model does not have, and would be wrong without these.
pub(super) fn model_with_effects(
    model: &Model,
    candidates: &[EffectCandidate],
    errors: Option<&DMatrix<f64>>,
) -> Model {
    let mut model = model.clone();
    for (place, candidate) in candidates.iter().enumerate() {
        let covariance = errors.map(|errors| own_covariance(candidates, place, errors));
        model.effects.push(applied_effect(candidate, covariance.as_ref()));
    }
    model
}

fn applied_effect(candidate: &EffectCandidate, covariance: Option<&DMatrix<f64>>) -> AppliedEffect {
    let quantity = |(i, (name, value)): (usize, (&String, &f64))| {
        let standard_error = covariance.map(|covariance| covariance[(i, i)].max(0.0).sqrt());
        (name.clone(), Quantity { standard_error, ..Quantity::new(*value, "diagnosed") })
    };
    AppliedEffect {
        name: candidate.effect.clone(),
        acts_on: form_target(candidate),
        parameters: candidate
            .form
            .parameters
            .keys()
            .zip(&candidate.at)
            .enumerate()
            .map(quantity)
            .collect(),
        form: candidate.form.file.clone(),
    }
}

/// Target of a form's action.
pub(super) fn form_target(candidate: &EffectCandidate) -> ActsOn {
    let form = &candidate.form;
    match (form.forces.is_empty(), form.measures.is_empty()) {
        (false, _) => ActsOn::Force,
        (true, false) => ActsOn::Measurement,
        _ => ActsOn::Inflow,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_from_0_to_360_deg() {
        assert!((full_circle("towards_deg", -38.7) - 321.3).abs() < 1e-9);
        assert_eq!(full_circle("from_deg", 360.0), 0.0);
        assert_eq!(full_circle("offset_deg", -1.5), -1.5);
    }
}
