//! Output of a prediction over a horizon, as text and as a CSV file.

use serde_json::Value;
use sistership_model::Law;

use crate::table::{TextTable, format_number};

/// Largest number of rows of the table.
const MAX_ROWS: usize = 13;

/// Columns of a track in a file; the columns of roll come last, for laws with roll.
const TRACK_COLUMNS: [&str; 9] =
    ["t_s", "x_m", "y_m", "psi_rad", "u_m_s", "v_m_s", "r_rad_s", "delta_rad", "n_rps"];
const ROLL_COLUMNS: [&str; 2] = ["phi_rad", "p_rad_s"];

/// Formats the track as CSV.
pub(super) fn track_csv(answer: &Value, law: &Law) -> String {
    let roll = if law.has_roll() { ROLL_COLUMNS.as_slice() } else { &[] };
    let columns: Vec<&str> = TRACK_COLUMNS.iter().chain(roll).copied().collect();
    let track = &answer["trajectory"];
    let row = |at: usize| {
        columns.iter().map(|column| track[column][at].to_string()).collect::<Vec<_>>().join(",")
    };
    let rows = (0..sample_count(answer)).map(row);
    [columns.join(",")].into_iter().chain(rows).map(|line| line + "\n").collect()
}

/// Formats positions at some instants, and the prediction interval.
pub(super) fn format_prediction(answer: &Value) -> String {
    let words = |key: &str| answer[key].as_str().unwrap_or_default();
    let head = format!("{}, law {}\n\n", words("model"), words("law"));
    let mut table = TextTable::new(["t s", "x m", "y m", "heading deg", "u m/s", "rudder deg"]);
    // Evenly spaced rows; the step is rounded up, so that the limit holds.
    let every = sample_count(answer).saturating_sub(1).div_ceil(MAX_ROWS - 1).max(1);
    for at in (0..sample_count(answer)).step_by(every) {
        table.add_row(row_cells(&answer["trajectory"], at));
    }
    let ends = [
        format_band(answer),
        format_stop(answer),
        format_outside(answer),
        format_outside_trials(answer),
    ];
    format!("{head}{table}{}", ends.concat())
}

fn sample_count(answer: &Value) -> usize {
    answer["trajectory"]["t_s"].as_array().map_or(0, Vec::len)
}

fn row_cells(track: &Value, at: usize) -> [String; 6] {
    let value = |column: &str| track[column][at].as_f64().unwrap_or(f64::NAN);
    let round = |value: f64, digits: i32| {
        format_number((value * 10f64.powi(digits)).round() / 10f64.powi(digits))
    };
    [
        round(value("t_s"), 2),
        round(value("x_m"), 1),
        round(value("y_m"), 1),
        round(value("psi_rad").to_degrees(), 1),
        round(value("u_m_s"), 2),
        round(value("delta_rad").to_degrees(), 1),
    ]
}

fn format_band(answer: &Value) -> String {
    let band = &answer["band"];
    let Some(last) = sample_count(answer).checked_sub(1).filter(|_| !band.is_null()) else {
        return String::new();
    };
    // Null if no draw has reached the end of the horizon.
    let ends = |column: &str| ["low", "high"].map(|end| band[end][column][last].as_f64());
    let words = |name: &str, [low, high]: [Option<f64>; 2]| match (low, high) {
        (Some(low), Some(high)) => format!("{name} {low:.1} to {high:.1}"),
        _ => format!("{name} unknown"),
    };
    let degrees = ends("psi_rad").map(|end| end.map(f64::to_degrees));
    format!(
        "at the end, 95 % of {} draws: {} m, {} m, {} deg\n",
        band["drawn"],
        words("x", ends("x_m")),
        words("y", ends("y_m")),
        words("heading", degrees)
    )
}

fn format_stop(answer: &Value) -> String {
    let stopped = &answer["stopped"];
    match stopped["reason"].as_str() {
        Some(reason) => format!("STOPPED after {} s: {reason}\n", stopped["t_s"]),
        None => String::new(),
    }
}

/// Formats a line for each of wind, current and depth that the model's trials do not cover.
fn format_outside_trials(answer: &Value) -> String {
    let inputs = answer["outside_trials"].as_array().into_iter().flatten();
    let line = |input: &Value| {
        Some(format!("OUTSIDE the conditions of the trials: {}\n", input["message"].as_str()?))
    };
    inputs.filter_map(line).collect()
}

fn format_outside(answer: &Value) -> String {
    match answer["outside"]["along"].as_str() {
        Some(along) => format!("OUTSIDE the range covered by the model's trials, in {along}\n"),
        None => String::new(),
    }
}
