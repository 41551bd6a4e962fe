//! Tables of the sources of particulars, parameters and settings.

use sistership_identification::refine::{RefinementSettings, TuningRange};

use crate::numbers::{self, format_known};
use crate::refinement::provenance::StatedQuantity;
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow, format_setting};

/// Table of the ship's particulars.
pub(crate) fn particulars_table(stated: &[StatedQuantity<'_>]) -> ReportTable {
    source_table("particular", stated)
}

/// Table of the law's parameters.
pub(crate) fn parameters_table(stated: &[StatedQuantity<'_>]) -> ReportTable {
    source_table("parameter", stated)
}

fn source_table(what: &str, stated: &[StatedQuantity<'_>]) -> ReportTable {
    let mut columns = vec![
        TableColumn::text_column(what, ""),
        TableColumn::prose_column("meaning"),
        TableColumn::number_column("value", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::text_column("source", ""),
    ];
    let remarked = stated.iter().any(|stated| stated.quantity.note.is_some());
    // The column of remarks only exists if there is one.
    columns.extend(remarked.then(|| TableColumn::prose_column("remark")));
    ReportTable {
        columns,
        rows: stated.iter().map(|stated| quantity_row(stated, remarked)).collect(),
    }
}

fn quantity_row(stated: &StatedQuantity<'_>, remarked: bool) -> TableRow {
    let source = TableCell::new(&stated.quantity.source);
    let source = match stated.kind {
        Some("estimated") => source.with_mark("estimated", "warn"),
        Some(kind) => source.with_mark(kind, "note"),
        None => source,
    };
    let value = numbers::format_stated(stated.quantity.value, 5);
    let mut cells = vec![
        TableCell::code_cell(stated.name),
        TableCell::new(&stated.meaning),
        TableCell::new(value),
        TableCell::new(stated.unit),
        source,
    ];
    cells.extend(remarked.then(|| TableCell::new(stated.quantity.note.as_deref().unwrap_or(""))));
    TableRow::from_cells(cells)
}

/// Meanings of the settings, in the order of the table; a setting that is not listed comes after
/// these.
const MEANINGS: [(&str, &str); 13] = [
    ("method", "the estimator"),
    ("ranges", "tuning ranges, by increasing distance from the source"),
    ("lambda_count", "values of λ compared in a range"),
    ("difference_s", "interval of the finite differences for accelerations, s"),
    (
        "restart_s",
        "interval after which simulations of held-out manoeuvres restart from the measured state, \
         s",
    ),
    (
        "longer_restarts_s",
        "further, longer intervals of this kind, s: errors are the geometric mean over all of them",
    ),
    (
        "smoothing_s",
        "smoothing interval of the measured motions with which these simulations are compared, s",
    ),
    ("part_s", "length of a part, if parts of manoeuvres are held out, s"),
    ("folds", "largest number of folds of the cross-validation"),
    ("hold_out_parts", "parts of manoeuvres, not whole ones, are held out"),
    ("roll_strength", "factor on the most probable strength of the prior of roll"),
    ("held_out", "trials held out of fit and selection"),
    ("algorithm_revision", "revision of the algorithm"),
];

/// Table of all settings with their meaning.
pub(crate) fn settings_table(settings: &RefinementSettings) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("setting", ""),
        TableColumn::prose_column("value"),
        TableColumn::prose_column("meaning"),
    ];
    let written = serde_json::to_value(settings).unwrap_or_default();
    let mut lines: Vec<(usize, TableRow)> = Vec::new();
    for (name, value) in written.as_object().into_iter().flatten() {
        let rank = MEANINGS.iter().position(|(known, _)| known == name).unwrap_or(MEANINGS.len());
        let meaning = MEANINGS.get(rank).map_or("", |(_, meaning)| meaning);
        let value =
            if name == "ranges" { ranges_text(&settings.ranges) } else { format_setting(value) };
        lines.push((
            rank,
            TableRow::from_cells(vec![
                TableCell::code_cell(name),
                TableCell::new(value),
                TableCell::new(meaning),
            ]),
        ));
    }
    lines.sort_by_key(|(rank, _)| *rank);
    ReportTable { columns, rows: lines.into_iter().map(|(_, row)| row).collect() }
}

/// Number and limits of the tuning ranges: `7, least λ from 1 to 10⁻⁶`.
fn ranges_text(ranges: &[TuningRange]) -> String {
    let least = |range: Option<&TuningRange>| {
        format_known(range.map(|range| range.lambda_min), |value| numbers::format_stated(value, 2))
    };
    format!(
        "{}, smallest λ from {} to {}",
        ranges.len(),
        least(ranges.first()),
        least(ranges.last())
    )
}
