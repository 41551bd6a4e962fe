//! Table of stopping, pull-outs and spirals of the refined model.

use sistership_simulation::manoeuvre::FurtherManoeuvres;
use sistership_simulation::metrics::{PullOutMetrics, SpiralMetrics, StoppingMetrics};

use super::results::pass;
use crate::numbers::{fixed, known, significant};
use crate::tables::{Cell, Column, Row, Table};

/// Table of the figures, under a heading for each manoeuvre.
pub(crate) fn further(sailed: &FurtherManoeuvres, lpp_m: f64) -> Table {
    let columns = vec![
        Column::text("figure", ""),
        Column::text("unit", ""),
        Column::number("refined", ""),
        Column::number("limit", "at most"),
        Column::text("", ""),
    ];
    let mut rows = Vec::new();
    if let Some(stop) = &sailed.stopping {
        rows.extend(stopping(stop, lpp_m));
    }
    for one in &sailed.pull_outs {
        rows.extend(pull_out(one));
    }
    if let Some(one) = &sailed.spiral {
        rows.extend(spiral(one));
    }
    Table { columns, rows }
}

fn figure(name: &str, unit: &str, value: Option<f64>) -> Row {
    let value = Cell::new(known(value, |value| significant(value, 3)));
    Row::of(vec![Cell::new(name), Cell::new(unit), value, Cell::new(""), Cell::new("")])
}

/// Row of a figure that has a limit.
fn limited(name: &str, unit: &str, value: Option<f64>, limit: f64, met: Option<bool>) -> Row {
    Row::of(vec![
        Cell::new(name),
        Cell::new(unit),
        Cell::new(known(value, |value| fixed(value, 2))),
        Cell::new(fixed(limit, 2)),
        pass(met),
    ])
}

fn stopping(stop: &StoppingMetrics, lpp_m: f64) -> Vec<Row> {
    let criterion = stop.criterion(lpp_m);
    let title = format!("full astern stop, revolutions to {} 1/s", significant(stop.astern_rps, 3));
    vec![
        Row::heading(&title),
        limited("track reach", "L", criterion.value, criterion.limit, criterion.pass),
        figure("track reach", "m", stop.track_reach_m),
        figure("head reach", "m", stop.head_reach_m),
        figure("deviation to starboard", "m", stop.lateral_deviation_m),
        figure("time", "s", stop.time_s),
    ]
}

fn pull_out(one: &PullOutMetrics) -> Vec<Row> {
    let side = if one.rudder_deg < 0.0 { "port" } else { "starboard" };
    let title = format!("pull-out of a turn with {} deg to {side}", one.rudder_deg.abs());
    vec![
        Row::heading(&title),
        figure("yaw rate in the turn", "deg/s", Some(one.turning_rate_deg_s)),
        figure("yaw rate left amidships", "deg/s", one.residual_rate_deg_s),
    ]
}

fn spiral(one: &SpiralMetrics) -> Vec<Row> {
    let width = one.loop_width_deg;
    vec![
        Row::heading("spirals"),
        limited(
            "width of the loop",
            "deg of rudder",
            Some(width),
            one.width_limit_deg,
            Some(width <= one.width_limit_deg),
        ),
        figure("height of the loop", "deg/s", Some(one.loop_height_deg_s)),
    ]
}
