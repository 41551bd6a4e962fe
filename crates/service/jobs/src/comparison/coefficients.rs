//! Comparison of coefficients.

use std::collections::BTreeSet;

use serde::Serialize;
use utoipa::ToSchema;

use super::comparison_model::ComparisonModel;

/// Value of a coefficient in one model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, ToSchema)]
pub struct Estimate {
    /// Its value.
    pub value: f64,
    /// Its standard error, if known.
    pub standard_error: Option<f64>,
}

/// A coefficient in every model.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ComparedCoefficient {
    /// Its name.
    pub name: String,
    /// Its value in each model; null where the model does not have it.
    pub values: Vec<Option<Estimate>>,
}

/// Lists every coefficient that at least one model has. Models of different laws may use one name
/// for coefficients of different meaning.
pub fn compare_coefficients(compared: &[ComparisonModel<'_>]) -> Vec<ComparedCoefficient> {
    // The union of the names, in alphabetical order.
    let names: BTreeSet<&String> =
        compared.iter().flat_map(|one| one.model.coefficients.keys()).collect();
    let row = |name: &String| {
        let of = |one: &ComparisonModel<'_>| {
            let quantity = one.model.coefficients.get(name)?;
            Some(Estimate { value: quantity.value, standard_error: quantity.standard_error })
        };
        ComparedCoefficient { name: name.clone(), values: compared.iter().map(of).collect() }
    };
    names.into_iter().map(row).collect()
}
