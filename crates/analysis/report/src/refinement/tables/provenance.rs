//! Tables of the sources of particulars, parameters and settings.

use sistership_identification::refine::{Range, Settings};

use crate::numbers::{self, known};
use crate::refinement::provenance::StatedQuantity;
use crate::tables::{Cell, Column, Row, Table, setting};

/// Table of the ship's particulars.
pub(crate) fn particulars(stated: &[StatedQuantity<'_>]) -> Table {
    with_sources("particular", stated)
}

/// Table of the law's parameters.
pub(crate) fn parameters(stated: &[StatedQuantity<'_>]) -> Table {
    with_sources("parameter", stated)
}

fn with_sources(what: &str, stated: &[StatedQuantity<'_>]) -> Table {
    let mut columns = vec![
        Column::text(what, ""),
        Column::prose("meaning"),
        Column::number("value", ""),
        Column::text("unit", ""),
        Column::text("source", ""),
    ];
    let remarked = stated.iter().any(|stated| stated.quantity.note.is_some());
    // The column of remarks only exists if there is one.
    columns.extend(remarked.then(|| Column::prose("remark")));
    Table { columns, rows: stated.iter().map(|stated| row(stated, remarked)).collect() }
}

fn row(stated: &StatedQuantity<'_>, remarked: bool) -> Row {
    let source = Cell::new(&stated.quantity.source);
    let source = match stated.kind {
        Some("estimated") => source.mark("estimated", "warn"),
        Some(kind) => source.mark(kind, "note"),
        None => source,
    };
    let value = numbers::stated(stated.quantity.value, 5);
    let mut cells = vec![
        Cell::code(stated.name),
        Cell::new(&stated.meaning),
        Cell::new(value),
        Cell::new(stated.unit),
        source,
    ];
    cells.extend(remarked.then(|| Cell::new(stated.quantity.note.as_deref().unwrap_or(""))));
    Row::of(cells)
}

/// Meanings of the settings, in the order of the table; a setting that is not listed comes after
/// these.
const MEANINGS: [(&str, &str); 13] = [
    ("method", "the estimator"),
    ("ranges", "tuning ranges, from the source outwards"),
    ("lambda_count", "values of λ tried in a range"),
    ("difference_s", "time over which accelerations are differenced, s"),
    (
        "restart_s",
        "simulations of manoeuvres left out start anew from the measured state every so often, s",
    ),
    (
        "longer_restarts_s",
        "longer such intervals, s: errors are the geometric mean over all of them",
    ),
    (
        "smoothing_s",
        "motions with which these simulations are compared are smoothed over so long, s",
    ),
    ("part_s", "where manoeuvres are left out part by part, how long a part is, s"),
    ("folds", "most groups of manoeuvres that are left out in turn"),
    (
        "hydrostatic_roll",
        "a source without roll begins with the stiffness of the metacentric height",
    ),
    (
        "plane_source",
        "a source of another law that does not roll says sway and yaw of a ship that stays upright",
    ),
    ("roll_strength", "how much stronger than the likeliest the prior of roll is"),
    ("held_out", "trials kept out of fit and choice altogether"),
];

/// Table of all settings with their meaning.
pub(crate) fn settings(settings: &Settings) -> Table {
    let columns =
        vec![Column::text("setting", ""), Column::prose("value"), Column::prose("meaning")];
    let written = serde_json::to_value(settings).unwrap_or_default();
    let mut lines: Vec<(usize, Row)> = Vec::new();
    for (name, value) in written.as_object().into_iter().flatten() {
        let rank = MEANINGS.iter().position(|(known, _)| known == name).unwrap_or(MEANINGS.len());
        let meaning = MEANINGS.get(rank).map_or("", |(_, meaning)| meaning);
        let value = if name == "ranges" { ranges(&settings.ranges) } else { setting(value) };
        lines.push((rank, Row::of(vec![Cell::code(name), Cell::new(value), Cell::new(meaning)])));
    }
    lines.sort_by_key(|(rank, _)| *rank);
    Table { columns, rows: lines.into_iter().map(|(_, row)| row).collect() }
}

/// Number and limits of the tuning ranges: `7, least λ from 1 to 10⁻⁶`.
fn ranges(ranges: &[Range]) -> String {
    let least = |range: Option<&Range>| {
        known(range.map(|range| range.lambda_min), |value| numbers::stated(value, 2))
    };
    format!("{}, least λ from {} to {}", ranges.len(), least(ranges.first()), least(ranges.last()))
}
