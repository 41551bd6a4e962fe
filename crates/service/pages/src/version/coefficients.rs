//! The list of coefficients on the page of a version.

use sistership_model::{Law, Model};
use sistership_report::numbers::{format_fixed, format_significant};

/// A coefficient with its standard error.
pub(super) struct CoefficientRow {
    pub name: String,
    pub value: String,
    pub error: String,
    /// Ratio of the error to the size of the value.
    pub share: String,
    pub source: String,
}

/// Returns the coefficients in the order of the law.
pub(super) fn coefficient_rows(model: &Model, law: &Law) -> Vec<CoefficientRow> {
    let ordered = law.coefficient_names();
    let place = |name: &String| ordered.iter().position(|known| known == name);
    // Coefficients that the law does not have come last, by name.
    let mut names: Vec<&String> = model.coefficients.keys().collect();
    names.sort_by_key(|name| (place(name).unwrap_or(usize::MAX), *name));
    names.into_iter().filter_map(|name| coefficient_row(model, name)).collect()
}

fn coefficient_row(model: &Model, name: &str) -> Option<CoefficientRow> {
    let quantity = model.coefficients.get(name)?;
    // The posterior has the standard deviations of a refined model; published models may state a
    // standard error.
    let posterior =
        model.posterior.as_ref().and_then(|known| known.deviations_by_name().get(name).copied());
    let error = posterior.or(quantity.standard_error);
    let share = error.filter(|_| quantity.value != 0.0).map(|error| error / quantity.value.abs());
    Some(CoefficientRow {
        name: name.to_owned(),
        value: format_significant(quantity.value, 5),
        error: error.map_or_else(String::new, |error| format_significant(error, 2)),
        share: share
            .map_or_else(String::new, |share| format!("{} %", format_fixed(100.0 * share, 0))),
        source: quantity.source.clone(),
    })
}
