//! Table of measured and simulated figures.

use crate::numbers::{known, signed, significant};
use crate::refinement::sailed::Sailed;
use crate::tables::{Cell, Column, Row, Table};

/// Table of the figures, under a heading for each trial.
pub(crate) fn sailed(figures: &[Sailed]) -> Table {
    let columns = vec![
        Column::text("figure", ""),
        Column::text("unit", ""),
        Column::number("measured", ""),
        Column::number("source", ""),
        Column::number("refined", ""),
        Column::number("source off by", "%"),
        Column::number("refined off by", "%"),
    ];
    let mut rows = Vec::new();
    let mut last = "";
    for figure in figures {
        if figure.trial != last {
            rows.push(Row::heading(&figure.trial));
            last = &figure.trial;
        }
        rows.push(row(figure));
    }
    Table { columns, rows }
}

fn row(figure: &Sailed) -> Row {
    let value = |value: Option<f64>| Cell::new(known(value, |value| significant(value, 4)));
    let off = |simulated: Option<f64>| {
        let both = simulated.zip(figure.measured).filter(|(_, measured)| *measured != 0.0);
        Cell::new(known(
            both.map(|(simulated, measured)| 100.0 * (simulated / measured - 1.0)),
            |value| signed(value, 1),
        ))
    };
    let mut cells = vec![Cell::new(figure.figure), Cell::new(figure.unit)];
    cells.extend([figure.measured, figure.source, figure.refined].map(value));
    cells.extend([figure.source, figure.refined].map(off));
    Row::of(cells)
}
