//! Table of all coefficients.

use crate::numbers::{fixed, known, signed, significant, superscript};
use crate::refinement::coefficients::{ChangedCoefficient, Coefficients};
use crate::tables::{Cell, Column, Row, Table};
use crate::words;

/// Table of all coefficients by axis, with values in one power of ten.
pub(crate) fn coefficients(coefficients: &Coefficients<'_>) -> Table {
    let exponent = coefficients.exponent();
    let unit = if exponent == 0 { String::new() } else { format!("×10{}", superscript(exponent)) };
    let columns = vec![
        Column::text("coefficient", ""),
        Column::text("unit", ""),
        Column::number("source", &unit),
        Column::number("refined", &unit),
        Column::number("standard error", &unit),
        Column::number("moved", "prior s.d."),
        Column::number("moved", "%"),
    ];
    let mut rows = Vec::new();
    for axis in &coefficients.axes {
        rows.push(Row::heading(words::axis(axis.axis)));
        rows.extend(axis.coefficients.iter().map(|change| row(change, exponent)));
    }
    Table { columns, rows }
}

fn row(coefficient: &ChangedCoefficient<'_>, exponent: i32) -> Row {
    let change = coefficient.change;
    let value = |value: f64| match exponent {
        0 => significant(value, 4),
        _ => fixed(value / 10_f64.powi(exponent), 2),
    };
    let name = Cell::code(&change.name);
    let name = match coefficient.collinear_group {
        Some(group) => name.mark(format!("group {group}"), "note"),
        None => name,
    };
    let source = Cell::new(value(change.source));
    Row::of(vec![
        name,
        Cell::new(&change.unit),
        if coefficient.source_estimated { source.mark("estimated", "warn") } else { source },
        Cell::new(value(change.refined)),
        Cell::new(value(change.standard_error)),
        Cell::new(signed(change.moved_sd, 2)),
        Cell::new(known(coefficient.moved_percent, |value| signed(value, 1))),
    ])
}
