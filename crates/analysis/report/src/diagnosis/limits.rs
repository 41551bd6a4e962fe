//! Detection limits and prior odds of effects.

use sistership_diagnosis::{DetectionLimit, Diagnosis, LimitedBy, Value};

use super::parameter::ShownParameter;
use crate::numbers::{known, significant};
use crate::tables::{Cell, Column, Row, Table};

/// Table of detection limits by effect, form and parameter.
pub(crate) fn limits(diagnosis: &Diagnosis) -> Table {
    let columns = vec![
        Column::text("effect", ""),
        Column::text("form", ""),
        Column::text("parameter", ""),
        Column::number("shown from", ""),
        Column::number("usual", ""),
        Column::text("unit", ""),
        Column::prose("told"),
    ];
    Table { columns, rows: diagnosis.limits.iter().map(row).collect() }
}

fn row(limit: &DetectionLimit) -> Row {
    // Converted to the displayed unit, which follows from the parameter's name.
    let shown = |value: f64| ShownParameter::of(&limit.parameter, &Value { value, se: 0.0 });
    let usual = shown(limit.usual);
    let size = known(limit.size, |size| significant(shown(size).value, 2));
    Row::of(vec![
        Cell::new(limit.effect.replace('-', " ")),
        Cell::code(&limit.form),
        Cell::new(&usual.words),
        Cell::new(size),
        Cell::new(significant(usual.value, 2)),
        Cell::new(usual.unit),
        Cell::new(limit.limited_by.map_or("yes", told)),
    ])
}

/// Reason why an effect cannot be detected.
fn told(limited_by: LimitedBy) -> &'static str {
    match limited_by {
        LimitedBy::Model => {
            "cannot tell: the model resembles it by its own errors; refine it first"
        }
        LimitedBy::Trials => "cannot tell: these trials do not excite it by itself",
        LimitedBy::Sensors => "cannot tell: the instruments scatter too much",
    }
}

/// Table of the prior odds of each effect.
pub(crate) fn odds(diagnosis: &Diagnosis) -> Table {
    let columns = vec![Column::text("effect", ""), Column::number("odds beforehand", "")];
    let row = |(name, odds): (&String, &f64)| {
        Row::of(vec![Cell::new(name.replace('-', " ")), Cell::new(significant(*odds, 2))])
    };
    Table { columns, rows: diagnosis.prior_odds.iter().map(row).collect() }
}
