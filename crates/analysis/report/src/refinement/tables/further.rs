//! Table of stopping, pull-outs and spirals of the refined model.

use sistership_simulation::manoeuvre::FurtherManoeuvres;
use sistership_simulation::metrics::{PullOutMetrics, SpiralMetrics, StoppingMetrics};

use super::results::pass_cell;
use crate::numbers::{format_fixed, format_known, format_significant};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Table of the figures, under a heading for each manoeuvre.
pub(crate) fn further_table(sailed: &FurtherManoeuvres, lpp_m: f64) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("figure", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("refined", ""),
        TableColumn::number_column("limit", "at most"),
        TableColumn::text_column("", ""),
    ];
    let mut rows = Vec::new();
    if let Some(stop) = &sailed.stopping {
        rows.extend(stopping_rows(stop, lpp_m));
    }
    for one in &sailed.pull_outs {
        rows.extend(pull_out_rows(one));
    }
    if let Some(one) = &sailed.spiral {
        rows.extend(spiral_rows(one));
    }
    ReportTable { columns, rows }
}

fn figure_row(name: &str, unit: &str, value: Option<f64>) -> TableRow {
    let value = TableCell::new(format_known(value, |value| format_significant(value, 3)));
    TableRow::from_cells(vec![
        TableCell::new(name),
        TableCell::new(unit),
        value,
        TableCell::new(""),
        TableCell::new(""),
    ])
}

/// Row of a figure that has a limit.
fn limited_row(
    name: &str,
    unit: &str,
    value: Option<f64>,
    limit: f64,
    met: Option<bool>,
) -> TableRow {
    TableRow::from_cells(vec![
        TableCell::new(name),
        TableCell::new(unit),
        TableCell::new(format_known(value, |value| format_fixed(value, 2))),
        TableCell::new(format_fixed(limit, 2)),
        pass_cell(met),
    ])
}

fn stopping_rows(stop: &StoppingMetrics, lpp_m: f64) -> Vec<TableRow> {
    let criterion = stop.track_reach_criterion(lpp_m);
    let title =
        format!("full astern stop, revolutions to {} 1/s", format_significant(stop.astern_rps, 3));
    vec![
        TableRow::heading_row(&title),
        limited_row("track reach", "L", criterion.value, criterion.limit, criterion.pass),
        figure_row("track reach", "m", stop.track_reach_m),
        figure_row("head reach", "m", stop.head_reach_m),
        figure_row("deviation to starboard", "m", stop.lateral_deviation_m),
        figure_row("time", "s", stop.time_s),
    ]
}

fn pull_out_rows(one: &PullOutMetrics) -> Vec<TableRow> {
    let side = if one.rudder_deg < 0.0 { "port" } else { "starboard" };
    let title = format!("pull-out of a turn with {} deg to {side}", one.rudder_deg.abs());
    vec![
        TableRow::heading_row(&title),
        figure_row("yaw rate in the turn", "deg/s", Some(one.turning_rate_deg_s)),
        figure_row("residual yaw rate amidships", "deg/s", one.residual_rate_deg_s),
    ]
}

fn spiral_rows(one: &SpiralMetrics) -> Vec<TableRow> {
    let width = one.loop_width_deg;
    vec![
        TableRow::heading_row("spirals"),
        limited_row(
            "loop width",
            "deg of rudder",
            Some(width),
            one.width_limit_deg,
            Some(width <= one.width_limit_deg),
        ),
        figure_row("loop height", "deg/s", Some(one.loop_height_deg_s)),
    ]
}
