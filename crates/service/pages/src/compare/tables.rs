//! Tables of a comparison: one row for each name, one cell for each version.

use sistership_simulation::manoeuvre::NamedFigure;

use super::simulations::VersionManoeuvres;
use crate::language::{say, say_word};
use crate::named::NamedVersion;
use crate::numbers::{format_fixed, format_significant};
use crate::terms::figure_words;
use crate::version::figures::pass_words;

/// A row: name, unit, and the cell of each version.
pub(super) struct ValueRow {
    pub name: String,
    pub unit: String,
    pub cells: Vec<TableCell>,
}

/// A value, and its difference from that of the first version.
#[derive(Default)]
pub(super) struct TableCell {
    pub value: String,
    pub beside: String,
    pub class: &'static str,
}

/// Returns the coefficients by name, in the order of the versions' laws.
pub(super) fn coefficient_rows(versions: &[NamedVersion]) -> Vec<ValueRow> {
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
        known.then(|| ValueRow { cells: value_cells(&values, 5), unit: String::new(), name })
    };
    names.into_iter().filter_map(row).collect()
}

/// Returns the figures of the standard manoeuvres.
pub(super) fn figure_rows(sailed: &[VersionManoeuvres]) -> Vec<ValueRow> {
    let all: Vec<Vec<NamedFigure>> = sailed.iter().map(plain_figures).collect();
    // All versions have the same figures in the same order; a version that could not be simulated
    // has none.
    let Some(first) = all.iter().find(|figures| !figures.is_empty()) else { return Vec::new() };
    let row = |figure: &NamedFigure| {
        let own = |figures: &Vec<NamedFigure>| {
            figures.iter().find(|one| one.name == figure.name).and_then(|one| one.value)
        };
        let values: Vec<Option<f64>> = all.iter().map(own).collect();
        ValueRow {
            name: figure_words(&figure.name),
            unit: say_word("unit", &figure.unit),
            cells: value_cells(&values, 4),
        }
    };
    first.iter().map(row).collect()
}

fn plain_figures(sailed: &VersionManoeuvres) -> Vec<NamedFigure> {
    let all = sailed.figures.iter().flat_map(|figures| figures.list_figures());
    all.filter(|figure| figure.pass.is_none() && !figure.name.starts_with("IMO")).collect()
}

/// Returns the criteria of IMO MSC.137(76), with value and verdict.
pub(super) fn criterion_rows(sailed: &[VersionManoeuvres]) -> Vec<ValueRow> {
    let Some(first) = sailed.iter().find_map(|one| one.figures.as_ref()) else {
        return Vec::new();
    };
    let row = |(place, criterion): (usize, &sistership_simulation::metrics::ImoCriterion)| {
        let own = |one: &VersionManoeuvres| {
            let own = one.figures.as_ref().and_then(|figures| figures.imo.get(place));
            own.map_or_else(TableCell::default, |own| {
                let (verdict, class) = pass_words(own.pass);
                let beside = say("compare-pass-limit").with("verdict", verdict);
                let beside = beside.with("limit", format_significant(own.limit, 3)).into();
                let value =
                    own.value.map_or_else(String::new, |value| format_significant(value, 4));
                TableCell { value, beside, class }
            })
        };
        ValueRow {
            name: say_word("criterion", &criterion.criterion),
            unit: say_word("unit", &criterion.unit),
            cells: sailed.iter().map(own).collect(),
        }
    };
    first.imo.iter().enumerate().map(row).collect()
}

fn value_cells(values: &[Option<f64>], digits: usize) -> Vec<TableCell> {
    let first = values.first().copied().flatten();
    let cell = |(place, value): (usize, &Option<f64>)| {
        let Some(value) = value else { return TableCell::default() };
        // Changes are relative to the first version, whose value must not be zero.
        let change = first.filter(|first| place > 0 && *first != 0.0);
        let change = change.map(|first| 100.0 * (value - first) / first.abs());
        let beside = change.map_or_else(String::new, |change| {
            let sign = if change >= 0.0 { "+" } else { "" };
            format!("{sign}{} %", format_fixed(change, if change.abs() < 10.0 { 1 } else { 0 }))
        });
        TableCell { value: format_significant(*value, digits), beside, class: "soft" }
    };
    values.iter().enumerate().map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_from_the_first_version() {
        let cells = value_cells(&[Some(-2.0), Some(-1.0), None, Some(-2.01)], 3);
        let beside: Vec<&str> = cells.iter().map(|cell| cell.beside.as_str()).collect();
        assert_eq!(beside, ["", "+50 %", "", "−0.5 %"]);
        assert_eq!(cells[2].value, "");
    }
}
