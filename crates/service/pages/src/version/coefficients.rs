//! The list of coefficients on the page of a version.

use sistership_model::{Law, Model};

use crate::language::say_word;
use crate::numbers::{format_fixed, format_significant};

/// A coefficient with its standard error.
pub(super) struct CoefficientRow {
    pub name: String,
    pub value: String,
    pub error: String,
    /// Ratio of the error to the size of the value.
    pub share: String,
    /// The same as a number, infinite if the error is unknown.
    pub relative: f64,
    pub source: String,
}

/// Coefficients of an axis, those that the data determine best first.
pub(super) struct AxisCoefficients {
    pub axis: &'static str,
    pub rows: Vec<CoefficientRow>,
    /// Number of coefficients that are determined.
    pub determined: usize,
}

/// Largest ratio of standard error and value of a coefficient that counts as determined.
const DETERMINED_SHARE: f64 = 0.25;

impl AxisCoefficients {
    /// Axis in words.
    pub fn words(&self) -> String {
        say_word("axis", self.axis)
    }
}

/// Order of the axes; others come first.
const AXES: [&str; 5] = ["X", "Y", "K", "N", "parameters"];
/// Axis of coefficients of all other names.
const OTHER_AXIS: &str = "other";

/// Returns the coefficients by axis, the determined ones first, then in the order of the law.
pub(super) fn coefficients_by_axis(model: &Model, law: &Law) -> Vec<AxisCoefficients> {
    let mut axes: Vec<AxisCoefficients> = Vec::new();
    for row in coefficient_rows(model, law) {
        let name = row.name.split('_').next().unwrap_or_default();
        let axis = AXES.into_iter().find(|axis| *axis == name).unwrap_or(OTHER_AXIS);
        match axes.iter_mut().find(|known| known.axis == axis) {
            Some(known) => known.rows.push(row),
            None => axes.push(AxisCoefficients { axis, rows: vec![row], determined: 0 }),
        }
    }
    axes.sort_by_key(|one| AXES.iter().position(|axis| *axis == one.axis));
    for one in &mut axes {
        // Stable: coefficients without an error keep the order of the law, after the others.
        one.rows.sort_by(|a, b| a.relative.total_cmp(&b.relative));
        one.determined = one.rows.iter().filter(|row| row.relative <= DETERMINED_SHARE).count();
    }
    axes
}

/// Returns the coefficients in the order of the law.
fn coefficient_rows(model: &Model, law: &Law) -> Vec<CoefficientRow> {
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
        relative: share.unwrap_or(f64::INFINITY),
        source: quantity.source.clone(),
    })
}
