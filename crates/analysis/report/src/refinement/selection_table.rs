//! Selection report: candidates that were evaluated before this model was selected.

use sistership_model_selection::{ReportLine, SelectionReport, SelectionStage};

use crate::numbers::{format_known, format_significant};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Table with one row for each source and law at each stage.
pub(crate) fn selection_report_table(ladder: &SelectionReport) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("source", ""),
        TableColumn::text_column("law", ""),
        TableColumn::text_column("estimator", ""),
        TableColumn::number_column("fitted", ""),
        TableColumn::number_column("effective", ""),
        TableColumn::number_column("error", ""),
        TableColumn::number_column("std. error", ""),
        TableColumn::number_column("elsewhere", ""),
        TableColumn::number_column("time", "s"),
        TableColumn::prose_column("reason"),
    ];
    ReportTable { columns, rows: ladder.lines.iter().map(candidate_row).collect() }
}

fn candidate_row(line: &ReportLine) -> TableRow {
    let source = TableCell::new(line.source.as_deref().unwrap_or("none"));
    let figure = |value: Option<f64>| {
        TableCell::new(format_known(value, |value| format_significant(value, 3)))
    };
    let cells = vec![
        match (line.chosen, line.reference) {
            (true, _) => source.with_mark("selected", "chosen"),
            (false, true) => source.with_mark("reference", "note"),
            (false, false) => source,
        },
        TableCell::new(&line.law),
        TableCell::new(stage_estimator(line.rung)),
        TableCell::new(line.coefficients.to_string()),
        figure(line.effective),
        figure(line.error),
        figure(line.standard_error),
        figure(line.variance),
        TableCell::new(format_significant(line.cost_s, 2)),
        TableCell::new(&line.reason),
    ];
    TableRow::from_cells(cells).with_highlight(line.chosen)
}

/// Estimator of a stage.
fn stage_estimator(rung: SelectionStage) -> &'static str {
    match rung {
        SelectionStage::CarriedOver => "none: source unchanged",
        SelectionStage::Weak => "weak form",
        SelectionStage::Trajectory => "trajectory form",
    }
}
