//! Selection report: candidates that were evaluated before this model was selected.

use sistership_model_selection::{Ladder, Line, Rung};

use crate::numbers::{known, significant};
use crate::tables::{Cell, Column, Row, Table};

/// Table with one row for each source and law at each stage.
pub(crate) fn table(ladder: &Ladder) -> Table {
    let columns = vec![
        Column::text("source", ""),
        Column::text("law", ""),
        Column::text("estimator", ""),
        Column::number("fitted", ""),
        Column::number("error", ""),
        Column::number("std. error", ""),
        Column::number("elsewhere", ""),
        Column::number("took", "s"),
        Column::prose("why"),
    ];
    Table { columns, rows: ladder.lines.iter().map(row).collect() }
}

fn row(line: &Line) -> Row {
    let source = Cell::new(line.source.as_deref().unwrap_or("none"));
    let figure = |value: Option<f64>| Cell::new(known(value, |value| significant(value, 3)));
    let cells = vec![
        match (line.chosen, line.reference) {
            (true, _) => source.mark("taken", "chosen"),
            (false, true) => source.mark("reference", "note"),
            (false, false) => source,
        },
        Cell::new(&line.law),
        Cell::new(estimator(line.rung)),
        Cell::new(line.coefficients.to_string()),
        figure(line.error),
        figure(line.standard_error),
        figure(line.variance),
        Cell::new(significant(line.cost_s, 2)),
        Cell::new(&line.reason),
    ];
    Row::of(cells).highlighted(line.chosen)
}

/// Estimator of a stage.
fn estimator(rung: Rung) -> &'static str {
    match rung {
        Rung::CarriedOver => "none: as carried over",
        Rung::Weak => "weak form",
        Rung::Trajectory => "trajectory form",
    }
}
