//! Table of all coefficients.

use crate::numbers::{
    format_fixed, format_known, format_signed, format_significant, format_superscript,
};
use crate::refinement::coefficients::{CoefficientEntry, CoefficientReport};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};
use crate::words;

/// Table of all coefficients by axis, with values in one power of ten.
pub(crate) fn coefficient_table(coefficients: &CoefficientReport<'_>) -> ReportTable {
    let exponent = coefficients.display_exponent();
    let unit =
        if exponent == 0 { String::new() } else { format!("×10{}", format_superscript(exponent)) };
    let columns = vec![
        TableColumn::text_column("coefficient", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("source", &unit),
        TableColumn::number_column("refined", &unit),
        TableColumn::number_column("standard error", &unit),
        TableColumn::number_column("moved", "prior s.d."),
        TableColumn::number_column("moved", "%"),
    ];
    let mut rows = Vec::new();
    for axis in &coefficients.axes {
        rows.push(TableRow::heading_row(words::axis_words(axis.axis)));
        rows.extend(axis.coefficients.iter().map(|change| coefficient_row(change, exponent)));
    }
    ReportTable { columns, rows }
}

fn coefficient_row(coefficient: &CoefficientEntry<'_>, exponent: i32) -> TableRow {
    let change = coefficient.change;
    let value = |value: f64| match exponent {
        0 => format_significant(value, 4),
        _ => format_fixed(value / 10_f64.powi(exponent), 2),
    };
    let name = TableCell::code_cell(&change.name);
    let name = match coefficient.collinear_group {
        Some(group) => name.with_mark(format!("group {group}"), "note"),
        None => name,
    };
    let source = TableCell::new(value(change.source));
    let error = TableCell::new(value(change.standard_error));
    TableRow::from_cells(vec![
        name,
        TableCell::new(&change.unit),
        if coefficient.source_estimated { source.with_mark("estimated", "warn") } else { source },
        TableCell::new(value(change.refined)),
        if coefficient.determined {
            error
        } else {
            error.with_mark("not determined by these trials; kept from the source", "note")
        },
        TableCell::new(format_signed(change.moved_sd, 2)),
        TableCell::new(format_known(coefficient.moved_percent, |value| format_signed(value, 1))),
    ])
}
