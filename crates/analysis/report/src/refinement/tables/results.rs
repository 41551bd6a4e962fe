//! Tables of the results: errors, tuning options, manoeuvres, criteria.

use sistership_identification::refine::StepOption;

use crate::error_row::ErrorRow;
use crate::numbers::{fixed, known, signed, significant};
use crate::refinement::manoeuvres::{CriterionComparison, ManoeuvreComparison, ManoeuvreFigure};
use crate::refinement::options::StepOptions;
use crate::refinement::summary::HeldOutErrors;
use crate::tables::{Cell, Column, Row, Table};

/// Table of errors before and after.
pub(crate) fn errors(errors: &HeldOutErrors<'_>) -> Table {
    let columns = vec![
        Column::text("channel", ""),
        Column::text("symbol", ""),
        Column::text("unit", ""),
        Column::number("source", "RMS error"),
        Column::number("refined", "RMS error"),
        Column::number("factor", "source ÷ refined"),
        Column::text("change", ""),
    ];
    Table { columns, rows: errors.rows.iter().map(error_row).collect() }
}

fn error_row(row: &ErrorRow) -> Row {
    let kind = match row.change().0 {
        "fell" => "good",
        "rose" => "bad",
        _ => "open",
    };
    Row::of(vec![
        Cell::new(row.quantity.name),
        Cell::new(row.quantity.symbol),
        Cell::new(row.quantity.unit),
        Cell::new(known(row.source, |value| significant(value, 3))),
        Cell::new(known(row.refined, |value| significant(value, 3))),
        Cell::new(known(row.factor, |value| fixed(value, 2))),
        Cell::new("").mark(row.change_text(), kind),
    ])
}

/// Table of the tuning options.
pub(crate) fn options(options: &StepOptions<'_>) -> Table {
    let each = |symbol: &str| {
        let title = |name: &String| Column::number(symbol, name);
        options.accelerations.iter().map(title).collect::<Vec<_>>()
    };
    let mut columns = vec![Column::text("step", ""), Column::number("least λ", "allowed")];
    columns.extend(each("λ").into_iter().chain(each("α")));
    columns.extend([Column::number("error", "left out"), Column::prose("outcome")]);
    let width = options.accelerations.len();
    Table { columns, rows: options.steps.iter().map(|step| option_row(step, width)).collect() }
}

fn option_row(step: &StepOption, width: usize) -> Row {
    let name = if step.step == "source" {
        "source as it is".to_owned()
    } else {
        format!("range {}", step.step)
    };
    let mut cells =
        vec![Cell::new(name), Cell::new(known(step.lambda_min, |value| significant(value, 2)))];
    for (values, digits) in [(&step.lambda, 2), (&step.alpha, 2)] {
        // An option may have fewer values than there are columns.
        cells.extend((0..width).map(|index| {
            Cell::new(known(values.get(index).copied(), |value| significant(value, digits)))
        }));
    }
    cells.push(Cell::new(known(step.error, |value| significant(value, 4))));
    cells.push(match (&step.reason, step.chosen) {
        (_, true) => Cell::new("").mark("✓ chosen", "chosen"),
        (Some(reason), _) => Cell::new(reason).mark("✗ refused", "bad"),
        (None, _) => Cell::new("not taken"),
    });
    Row::of(cells).highlighted(step.chosen)
}

/// Table of turning circles, in metres and ship lengths.
pub(crate) fn turns(comparison: &ManoeuvreComparison<'_>) -> Table {
    let columns = vec![
        Column::text("figure", ""),
        Column::number("source", "m"),
        Column::number("refined", "m"),
        Column::number("source", "L"),
        Column::number("refined", "L"),
        Column::number("change", "%"),
        Column::number("95 % band", "m"),
    ];
    let lengths = |value: Option<f64>| {
        known(value.zip(comparison.lpp_m).map(|(m, l)| m / l), |value| fixed(value, 2))
    };
    let row = |figure: &ManoeuvreFigure| {
        let mut cells = pair_cells(figure, |value| significant(value, 4));
        cells.extend(
            [figure.pair.source, figure.pair.refined].map(|value| Cell::new(lengths(value))),
        );
        cells.push(change_cell(figure));
        cells.push(band_cell(figure.band, |value| significant(value, 4)));
        Row::of(cells)
    };
    Table { columns, rows: grouped(&comparison.turns, row) }
}

/// Table of zigzags.
pub(crate) fn zigzags(comparison: &ManoeuvreComparison<'_>) -> Table {
    let columns = vec![
        Column::text("figure", ""),
        Column::text("unit", ""),
        Column::number("source", ""),
        Column::number("refined", ""),
        Column::number("change", "%"),
        Column::number("95 % band", ""),
    ];
    let row = |figure: &ManoeuvreFigure| {
        let mut cells = pair_cells(figure, |value| fixed(value, 1));
        cells.insert(1, Cell::new(figure.unit));
        cells.push(change_cell(figure));
        cells.push(band_cell(figure.band, |value| fixed(value, 1)));
        Row::of(cells)
    };
    Table { columns, rows: grouped(&comparison.zigzags, row) }
}

fn pair_cells(figure: &ManoeuvreFigure, format: impl Fn(f64) -> String) -> Vec<Cell> {
    let value = |value: Option<f64>| Cell::new(known(value, &format));
    vec![Cell::new(figure.figure), value(figure.pair.source), value(figure.pair.refined)]
}

/// Cell of an uncertainty band: the interval of 95 % of the models drawn from the posterior.
fn band_cell(band: Option<[f64; 2]>, write: impl Fn(f64) -> String) -> Cell {
    Cell::new(band.map_or_else(
        || known(None, &write),
        |[low, high]| format!("{} to {}", write(low), write(high)),
    ))
}

fn change_cell(figure: &ManoeuvreFigure) -> Cell {
    let both = figure.pair.source.zip(figure.pair.refined).filter(|(source, _)| *source != 0.0);
    Cell::new(known(
        both.map(|(source, refined)| 100.0 * (refined - source) / source.abs()),
        |value| signed(value, 1),
    ))
}

/// Rows of figures, under a heading for each manoeuvre.
fn grouped(figures: &[ManoeuvreFigure], row: impl Fn(&ManoeuvreFigure) -> Row) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut last = "";
    for figure in figures {
        // Figures come grouped by manoeuvre.
        if figure.manoeuvre != last {
            rows.push(Row::heading(&figure.manoeuvre));
            last = &figure.manoeuvre;
        }
        rows.push(row(figure));
    }
    rows
}

/// Table of the IMO criteria.
pub(crate) fn imo(comparison: &ManoeuvreComparison<'_>) -> Table {
    let columns = vec![
        Column::text("criterion", ""),
        Column::text("unit", ""),
        Column::number("limit", "at most"),
        Column::number("source", ""),
        Column::text("", ""),
        Column::number("refined", ""),
        Column::text("", ""),
        Column::number("95 % band", ""),
        Column::number("met by", "% of draws"),
    ];
    Table { columns, rows: comparison.imo.iter().map(imo_row).collect() }
}

fn imo_row(verdict: &CriterionComparison<'_>) -> Row {
    let value = |value: Option<f64>| Cell::new(known(value, |value| fixed(value, 2)));
    Row::of(vec![
        Cell::new(verdict.criterion),
        Cell::new(verdict.unit),
        Cell::new(fixed(verdict.limit, 2)),
        value(verdict.source),
        pass(verdict.source_pass),
        value(verdict.refined),
        pass(verdict.refined_pass),
        band_cell(verdict.band, |value| fixed(value, 2)),
        Cell::new(known(verdict.pass_share, |share| fixed(100.0 * share, 0))),
    ])
}

pub(super) fn pass(pass: Option<bool>) -> Cell {
    match pass {
        Some(true) => Cell::new("").mark("✓ pass", "good"),
        Some(false) => Cell::new("").mark("✗ fail", "bad"),
        None => Cell::new("").mark("? unknown", "open"),
    }
}
