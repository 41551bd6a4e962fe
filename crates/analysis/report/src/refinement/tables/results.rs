//! Tables of the results: errors, tuning options, manoeuvres, criteria.

use sistership_identification::refine::StepOption;

use crate::error_row::ErrorRow;
use crate::numbers::{format_fixed, format_known, format_signed, format_significant};
use crate::refinement::manoeuvres::{CriterionComparison, ManoeuvreComparison, ManoeuvreFigure};
use crate::refinement::options::StepOptions;
use crate::refinement::summary::HeldOutErrors;
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Table of errors before and after.
pub(crate) fn error_table(errors: &HeldOutErrors<'_>) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("channel", ""),
        TableColumn::text_column("symbol", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("source", "RMS error"),
        TableColumn::number_column("refined", "RMS error"),
        TableColumn::number_column("factor", "source ÷ refined"),
        TableColumn::text_column("change", ""),
    ];
    ReportTable { columns, rows: errors.rows.iter().map(error_row).collect() }
}

fn error_row(row: &ErrorRow) -> TableRow {
    let kind = match row.error_change().0 {
        "fell" => "good",
        "rose" => "bad",
        _ => "open",
    };
    TableRow::from_cells(vec![
        TableCell::new(row.quantity.name),
        TableCell::new(row.quantity.symbol),
        TableCell::new(row.quantity.unit),
        TableCell::new(format_known(row.source, |value| format_significant(value, 3))),
        TableCell::new(format_known(row.refined, |value| format_significant(value, 3))),
        TableCell::new(format_known(row.factor, |value| format_fixed(value, 2))),
        TableCell::new("").with_mark(row.change_text(), kind),
    ])
}

/// Table of the tuning options.
pub(crate) fn option_table(options: &StepOptions<'_>) -> ReportTable {
    let each = |symbol: &str| {
        let title = |name: &String| TableColumn::number_column(symbol, name);
        options.accelerations.iter().map(title).collect::<Vec<_>>()
    };
    let mut columns = vec![
        TableColumn::text_column("step", ""),
        TableColumn::number_column("least λ", "allowed"),
    ];
    columns.extend(each("λ").into_iter().chain(each("α")));
    columns.extend([
        TableColumn::number_column("error", "held-out"),
        TableColumn::prose_column("outcome"),
    ]);
    let width = options.accelerations.len();
    ReportTable {
        columns,
        rows: options.steps.iter().map(|step| option_row(step, width)).collect(),
    }
}

fn option_row(step: &StepOption, width: usize) -> TableRow {
    let name = if step.step == "source" {
        "source unchanged".to_owned()
    } else {
        format!("range {}", step.step)
    };
    let mut cells = vec![
        TableCell::new(name),
        TableCell::new(format_known(step.lambda_min, |value| format_significant(value, 2))),
    ];
    for (values, digits) in [(&step.lambda, 2), (&step.alpha, 2)] {
        // An option may have fewer values than there are columns.
        cells.extend((0..width).map(|index| {
            TableCell::new(format_known(values.get(index).copied(), |value| {
                format_significant(value, digits)
            }))
        }));
    }
    cells.push(TableCell::new(format_known(step.error, |value| format_significant(value, 4))));
    cells.push(match (&step.reason, step.chosen) {
        (_, true) => TableCell::new("").with_mark("✓ chosen", "chosen"),
        (Some(reason), _) => TableCell::new(reason).with_mark("✗ refused", "bad"),
        (None, _) => TableCell::new("not selected"),
    });
    TableRow::from_cells(cells).with_highlight(step.chosen)
}

/// Table of turning circles, in metres and ship lengths.
pub(crate) fn turn_table(comparison: &ManoeuvreComparison<'_>) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("figure", ""),
        TableColumn::number_column("source", "m"),
        TableColumn::number_column("refined", "m"),
        TableColumn::number_column("source", "L"),
        TableColumn::number_column("refined", "L"),
        TableColumn::number_column("change", "%"),
        TableColumn::number_column("95 % band", "m"),
    ];
    let lengths = |value: Option<f64>| {
        format_known(value.zip(comparison.lpp_m).map(|(m, l)| m / l), |value| {
            format_fixed(value, 2)
        })
    };
    let row = |figure: &ManoeuvreFigure| {
        let mut cells = pair_cells(figure, |value| format_significant(value, 4));
        cells.extend(
            [figure.pair.source, figure.pair.refined].map(|value| TableCell::new(lengths(value))),
        );
        cells.push(change_cell(figure));
        cells.push(band_cell(figure.band, |value| format_significant(value, 4)));
        TableRow::from_cells(cells)
    };
    ReportTable { columns, rows: grouped_rows(&comparison.turns, row) }
}

/// Table of zigzags.
pub(crate) fn zigzag_table(comparison: &ManoeuvreComparison<'_>) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("figure", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("source", ""),
        TableColumn::number_column("refined", ""),
        TableColumn::number_column("change", "%"),
        TableColumn::number_column("95 % band", ""),
    ];
    let row = |figure: &ManoeuvreFigure| {
        let mut cells = pair_cells(figure, |value| format_fixed(value, 1));
        cells.insert(1, TableCell::new(figure.unit));
        cells.push(change_cell(figure));
        cells.push(band_cell(figure.band, |value| format_fixed(value, 1)));
        TableRow::from_cells(cells)
    };
    ReportTable { columns, rows: grouped_rows(&comparison.zigzags, row) }
}

fn pair_cells(figure: &ManoeuvreFigure, format: impl Fn(f64) -> String) -> Vec<TableCell> {
    let value = |value: Option<f64>| TableCell::new(format_known(value, &format));
    vec![TableCell::new(figure.figure), value(figure.pair.source), value(figure.pair.refined)]
}

/// Cell of an uncertainty band: the interval of 95 % of the models drawn from the posterior.
fn band_cell(band: Option<[f64; 2]>, write: impl Fn(f64) -> String) -> TableCell {
    TableCell::new(band.map_or_else(
        || format_known(None, &write),
        |[low, high]| format!("{} to {}", write(low), write(high)),
    ))
}

fn change_cell(figure: &ManoeuvreFigure) -> TableCell {
    let both = figure.pair.source.zip(figure.pair.refined).filter(|(source, _)| *source != 0.0);
    TableCell::new(format_known(
        both.map(|(source, refined)| 100.0 * (refined - source) / source.abs()),
        |value| format_signed(value, 1),
    ))
}

/// Rows of figures, under a heading for each manoeuvre.
fn grouped_rows(
    figures: &[ManoeuvreFigure],
    row: impl Fn(&ManoeuvreFigure) -> TableRow,
) -> Vec<TableRow> {
    let mut rows = Vec::new();
    let mut last = "";
    for figure in figures {
        // Figures come grouped by manoeuvre.
        if figure.manoeuvre != last {
            rows.push(TableRow::heading_row(&figure.manoeuvre));
            last = &figure.manoeuvre;
        }
        rows.push(row(figure));
    }
    rows
}

/// Table of the IMO criteria.
pub(crate) fn criteria_table(comparison: &ManoeuvreComparison<'_>) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("criterion", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("limit", "at most"),
        TableColumn::number_column("source", ""),
        TableColumn::text_column("", ""),
        TableColumn::number_column("refined", ""),
        TableColumn::text_column("", ""),
        TableColumn::number_column("95 % band", ""),
        TableColumn::number_column("met in", "% of draws"),
    ];
    ReportTable { columns, rows: comparison.imo.iter().map(imo_row).collect() }
}

fn imo_row(verdict: &CriterionComparison<'_>) -> TableRow {
    let value =
        |value: Option<f64>| TableCell::new(format_known(value, |value| format_fixed(value, 2)));
    TableRow::from_cells(vec![
        TableCell::new(verdict.criterion),
        TableCell::new(verdict.unit),
        TableCell::new(format_fixed(verdict.limit, 2)),
        value(verdict.source),
        pass_cell(verdict.source_pass),
        value(verdict.refined),
        pass_cell(verdict.refined_pass),
        band_cell(verdict.band, |value| format_fixed(value, 2)),
        TableCell::new(format_known(verdict.pass_share, |share| format_fixed(100.0 * share, 0))),
    ])
}

pub(crate) fn pass_cell(pass: Option<bool>) -> TableCell {
    match pass {
        Some(true) => TableCell::new("").with_mark("✓ pass", "good"),
        Some(false) => TableCell::new("").with_mark("✗ fail", "bad"),
        None => TableCell::new("").with_mark("? unknown", "open"),
    }
}
