//! Table of measured and simulated figures.

use crate::numbers::{format_known, format_signed, format_significant};
use crate::refinement::measured_figures::MeasuredFigure;
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Table of the figures, under a heading for each trial.
pub(crate) fn measured_table(figures: &[MeasuredFigure]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("figure", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("measured", ""),
        TableColumn::number_column("source", ""),
        TableColumn::number_column("refined", ""),
        TableColumn::number_column("error of source", "%"),
        TableColumn::number_column("error of refined", "%"),
    ];
    let mut rows = Vec::new();
    let mut last = "";
    for figure in figures {
        if figure.trial != last {
            rows.push(TableRow::heading_row(&figure.trial));
            last = &figure.trial;
        }
        rows.push(measured_row(figure));
    }
    ReportTable { columns, rows }
}

fn measured_row(figure: &MeasuredFigure) -> TableRow {
    let value = |value: Option<f64>| {
        TableCell::new(format_known(value, |value| format_significant(value, 4)))
    };
    let off = |simulated: Option<f64>| {
        let both = simulated.zip(figure.measured).filter(|(_, measured)| *measured != 0.0);
        TableCell::new(format_known(
            both.map(|(simulated, measured)| 100.0 * (simulated / measured - 1.0)),
            |value| format_signed(value, 1),
        ))
    };
    let mut cells = vec![TableCell::new(figure.figure), TableCell::new(figure.unit)];
    cells.extend([figure.measured, figure.source, figure.refined].map(value));
    cells.extend([figure.source, figure.refined].map(off));
    TableRow::from_cells(cells)
}
