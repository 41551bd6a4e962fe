//! Orders over time from a CSV file.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use serde::Serialize;

use crate::failure::{Failure, about_file};
use crate::zoo::read_text_file;

/// Largest number of faults that are reported for a file.
const MAX_FAULTS: usize = 20;

/// Orders from a time on; those not given stay unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct OrderRow {
    pub t_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta_rad: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub n_rps: Option<f64>,
}

/// Content of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum OrderColumn {
    Time,
    Degrees,
    Radians,
    Revolutions,
}

/// Reads the orders of a file.
///
/// # Errors
/// Returns an error that names every faulty row and column.
pub(super) fn read_orders(path: &Path) -> Result<Vec<OrderRow>, Failure> {
    parse_orders(&read_text_file(path)?).map_err(|faults| about_file(path, faults.join("\n")))
}

fn parse_orders(text: &str) -> Result<Vec<OrderRow>, Vec<String>> {
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .flexible(true)
        // Spreadsheets write a byte order mark, which would become part of the first name.
        .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    let header = reader.headers().map_err(|error| vec![error.to_string()])?;
    let columns = parse_header(header).map_err(|fault| vec![fault])?;
    let (mut orders, mut faults) = (Vec::<OrderRow>::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| vec![error.to_string()])?;
        let line = record.position().map_or(0, csv::Position::line);
        match parse_row(&record, &columns) {
            Ok(one) if orders.last().is_some_and(|before| one.t_s <= before.t_s) => {
                faults.push(format!("line {line}, t_s: must be later than the row before"));
            }
            Ok(one) => orders.push(one),
            Err(found) => faults.extend(found.iter().map(|fault| format!("line {line}, {fault}"))),
        }
    }
    if orders.is_empty() && faults.is_empty() {
        faults.push("has no rows; give at least one order".to_owned());
    }
    if faults.is_empty() { Ok(orders) } else { Err(limit_faults(faults)) }
}

/// Limits the faults to a readable number.
fn limit_faults(mut faults: Vec<String>) -> Vec<String> {
    let further = faults.len().saturating_sub(MAX_FAULTS);
    faults.truncate(MAX_FAULTS);
    if further > 0 {
        faults.push(format!("and {further} more"));
    }
    faults
}

fn parse_header(header: &StringRecord) -> Result<Vec<OrderColumn>, String> {
    let mut columns = Vec::new();
    for name in header {
        let column = match name {
            "t_s" => OrderColumn::Time,
            "delta_deg" => OrderColumn::Degrees,
            "delta_rad" => OrderColumn::Radians,
            "n_rps" => OrderColumn::Revolutions,
            other => {
                let known = "t_s, delta_deg or delta_rad, n_rps";
                return Err(format!("line 1: `{other}` is not a column of orders; use {known}"));
            }
        };
        if columns.contains(&column) {
            return Err(format!("line 1: the column `{name}` appears twice; keep one"));
        }
        columns.push(column);
    }
    if columns.contains(&OrderColumn::Degrees) && columns.contains(&OrderColumn::Radians) {
        return Err("line 1: give delta_deg or delta_rad, not both".to_owned());
    }
    match columns.contains(&OrderColumn::Time) {
        true => Ok(columns),
        false => Err("line 1: the column `t_s` is missing".to_owned()),
    }
}

fn parse_row(cells: &StringRecord, columns: &[OrderColumn]) -> Result<OrderRow, Vec<String>> {
    if cells.len() != columns.len() {
        return Err(vec![format!(
            "has {} cells, but the header has {}",
            cells.len(),
            columns.len()
        )]);
    }
    let (mut orders, mut faults) =
        (OrderRow { t_s: f64::NAN, delta_rad: None, n_rps: None }, vec![]);
    for (place, (cell, column)) in cells.iter().zip(columns).enumerate() {
        let value = match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            // An empty cell keeps the previous order.
            _ if cell.is_empty() && *column != OrderColumn::Time => continue,
            _ => {
                faults.push(format!("column {}: `{cell}` is not a finite number", place + 1));
                continue;
            }
        };
        match column {
            OrderColumn::Time => orders.t_s = value,
            OrderColumn::Degrees => orders.delta_rad = Some(value.to_radians()),
            OrderColumn::Radians => orders.delta_rad = Some(value),
            OrderColumn::Revolutions => orders.n_rps = Some(value),
        }
    }
    if faults.is_empty() { Ok(orders) } else { Err(faults) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_empty_stays_and_degrees_are_converted() {
        let orders = parse_orders("\u{feff}t_s,delta_deg,n_rps\n0,180,\n\n2.5,,1.5\n").unwrap();
        let pi = Some(std::f64::consts::PI);
        assert_eq!(orders[0], OrderRow { t_s: 0.0, delta_rad: pi, n_rps: None });
        assert_eq!(orders[1], OrderRow { t_s: 2.5, delta_rad: None, n_rps: Some(1.5) });
    }

    #[test]
    fn every_fault_is_told_with_its_line() {
        let faults = parse_orders("t_s,delta_rad\n0,x\n1,NaN\n5,0\n4,0\n6\n,1").unwrap_err();
        let starts = ["line 2, column 2: `x`", "line 3, column 2: `NaN`", "line 5, t_s"];
        for (fault, start) in faults.iter().zip(starts) {
            assert!(fault.starts_with(start), "{fault}");
        }
        assert_eq!(faults.len(), 5, "{faults:?}");
        for text in ["", "t_s", "t_s,rudder\n0,1", "n_rps\n1", "t_s,t_s\n0,0"] {
            assert!(parse_orders(text).is_err(), "{text}");
        }
    }
}
