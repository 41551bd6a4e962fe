//! Tables of a comparison: one row for each name, one cell for each version.

use sistership_report::numbers::{fixed, significant};
use sistership_simulation::manoeuvre::Figure;

use super::sailed::Sailed;
use crate::named::NamedVersion;

/// A row: name, unit, and the cell of each version.
pub(super) struct ValueRow {
    pub name: String,
    pub unit: String,
    pub cells: Vec<Cell>,
}

/// A value, and its difference from that of the first version.
#[derive(Default)]
pub(super) struct Cell {
    pub value: String,
    pub beside: String,
    pub class: &'static str,
}

/// Returns the coefficients by name, in the order of the versions' laws.
pub(super) fn coefficients(versions: &[NamedVersion]) -> Vec<ValueRow> {
    let mut names: Vec<String> = Vec::new();
    for version in versions {
        let own = version.law.coefficient_names();
        names.extend(own.into_iter().filter(|name| !names.contains(name)).collect::<Vec<_>>());
    }
    let of = |version: &NamedVersion, name: &str| {
        version.document.model.coefficients.get(name).map(|quantity| quantity.value)
    };
    let row = |name: String| {
        let values: Vec<Option<f64>> = versions.iter().map(|version| of(version, &name)).collect();
        // A coefficient that the law has but no model uses gets no row.
        let known = values.iter().any(Option::is_some);
        known.then(|| ValueRow { cells: cells(&values, 5), unit: String::new(), name })
    };
    names.into_iter().filter_map(row).collect()
}

/// Returns the figures of the standard manoeuvres.
pub(super) fn figures(sailed: &[Sailed]) -> Vec<ValueRow> {
    let all: Vec<Vec<Figure>> = sailed.iter().map(plain).collect();
    // All versions have the same figures in the same order; a version that could not be simulated
    // has none.
    let Some(first) = all.iter().find(|figures| !figures.is_empty()) else { return Vec::new() };
    let row = |figure: &Figure| {
        let own = |figures: &Vec<Figure>| {
            figures.iter().find(|one| one.name == figure.name).and_then(|one| one.value)
        };
        let values: Vec<Option<f64>> = all.iter().map(own).collect();
        ValueRow { name: figure.name.clone(), unit: figure.unit.clone(), cells: cells(&values, 4) }
    };
    first.iter().map(row).collect()
}

fn plain(sailed: &Sailed) -> Vec<Figure> {
    let all = sailed.figures.iter().flat_map(|figures| figures.figures());
    all.filter(|figure| figure.pass.is_none() && !figure.name.starts_with("IMO")).collect()
}

/// Returns the criteria of IMO MSC.137(76), with value and verdict.
pub(super) fn criteria(sailed: &[Sailed]) -> Vec<ValueRow> {
    let Some(first) = sailed.iter().find_map(|one| one.figures.as_ref()) else {
        return Vec::new();
    };
    let row = |(place, criterion): (usize, &sistership_simulation::metrics::Criterion)| {
        let own = |one: &Sailed| {
            let own = one.figures.as_ref().and_then(|figures| figures.imo.get(place));
            own.map_or_else(Cell::default, |own| {
                let (beside, class) = match own.pass {
                    Some(true) => ("met", "good"),
                    Some(false) => ("not met", "bad"),
                    None => ("unknown", ""),
                };
                let limit = significant(own.limit, 3);
                let value = own.value.map_or_else(String::new, |value| significant(value, 4));
                Cell { value, beside: format!("{beside}, limit {limit}"), class }
            })
        };
        ValueRow {
            name: criterion.criterion.clone(),
            unit: criterion.unit.clone(),
            cells: sailed.iter().map(own).collect(),
        }
    };
    first.imo.iter().enumerate().map(row).collect()
}

fn cells(values: &[Option<f64>], digits: usize) -> Vec<Cell> {
    let first = values.first().copied().flatten();
    let cell = |(place, value): (usize, &Option<f64>)| {
        let Some(value) = value else { return Cell::default() };
        // Changes are relative to the first version, whose value must not be zero.
        let change = first.filter(|first| place > 0 && *first != 0.0);
        let change = change.map(|first| 100.0 * (value - first) / first.abs());
        let beside = change.map_or_else(String::new, |change| {
            let sign = if change >= 0.0 { "+" } else { "" };
            format!("{sign}{} %", fixed(change, if change.abs() < 10.0 { 1 } else { 0 }))
        });
        Cell { value: significant(*value, digits), beside, class: "soft" }
    };
    values.iter().enumerate().map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_from_the_first_version() {
        let cells = cells(&[Some(-2.0), Some(-1.0), None, Some(-2.01)], 3);
        let beside: Vec<&str> = cells.iter().map(|cell| cell.beside.as_str()).collect();
        assert_eq!(beside, ["", "+50 %", "", "−0.5 %"]);
        assert_eq!(cells[2].value, "");
    }
}
