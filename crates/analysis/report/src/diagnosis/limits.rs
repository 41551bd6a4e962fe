//! Detection limits and prior odds of effects.

use sistership_diagnosis::{DetectionLimit, Diagnosis, LimitedBy, ValueWithError};

use super::parameter::DisplayParameter;
use crate::numbers::{format_known, format_significant};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Table of detection limits by effect, form and parameter.
pub(crate) fn limit_table(diagnosis: &Diagnosis) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("effect", ""),
        TableColumn::text_column("form", ""),
        TableColumn::text_column("parameter", ""),
        TableColumn::number_column("detection limit", ""),
        TableColumn::number_column("usual", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::prose_column("detectable"),
    ];
    ReportTable { columns, rows: diagnosis.limits.iter().map(limit_row).collect() }
}

fn limit_row(limit: &DetectionLimit) -> TableRow {
    // Converted to the displayed unit, which follows from the parameter's name.
    let shown = |value: f64| {
        DisplayParameter::from_value(&limit.parameter, &ValueWithError { value, se: 0.0 })
    };
    let usual = shown(limit.usual);
    let size = format_known(limit.size, |size| format_significant(shown(size).value, 2));
    TableRow::from_cells(vec![
        TableCell::new(limit.effect.replace('-', " ")),
        TableCell::code_cell(&limit.form),
        TableCell::new(&usual.words),
        TableCell::new(size),
        TableCell::new(format_significant(usual.value, 2)),
        TableCell::new(usual.unit),
        TableCell::new(limit.limited_by.map_or("yes", limit_reason)),
    ])
}

/// Reason why an effect cannot be detected.
fn limit_reason(limited_by: LimitedBy) -> &'static str {
    match limited_by {
        LimitedBy::Model => "no: errors of the model have the same shape; refine the model first",
        LimitedBy::Trials => "no: these trials do not excite it separately",
        LimitedBy::Sensors => "no: the instruments are too noisy",
    }
}

/// Table of the prior odds of each effect.
pub(crate) fn odds_table(diagnosis: &Diagnosis) -> ReportTable {
    let columns =
        vec![TableColumn::text_column("effect", ""), TableColumn::number_column("prior odds", "")];
    let row = |(name, odds): (&String, &f64)| {
        TableRow::from_cells(vec![
            TableCell::new(name.replace('-', " ")),
            TableCell::new(format_significant(*odds, 2)),
        ])
    };
    ReportTable { columns, rows: diagnosis.prior_odds.iter().map(row).collect() }
}
