//! Detection of times written as text, or as days of a sheet.

use crate::clock::looks_serial;
use crate::decimals::DecimalMarks;
use crate::number::parse_number;
use crate::stamp::{DateOrder, StampDate, parse_stamp};

/// Returns the unit of a column of such times; `None` if it contains anything else.
pub(crate) fn written_time(header: &str, cells: &[&str]) -> Option<&'static str> {
    let first = cells.iter().find(|cell| !cell.is_empty())?;
    let Some(stamp) = parse_stamp(first, DateOrder::Open) else {
        return serial_unit(header, cells);
    };
    // A column of dates alone repeats the same date: most cells must differ from the first.
    let moves = cells.iter().filter(|cell| cell != &first).count() > cells.len() / 2;
    let unit = match stamp.date {
        StampDate::Known(_) => "timestamp",
        StampDate::Absent => "hh:mm:ss",
        StampDate::Either(_) => "auto",
    };
    (moves || cells.len() < 3).then_some(unit)
}

fn serial_unit(header: &str, cells: &[&str]) -> Option<&'static str> {
    let mut decimals = DecimalMarks::new(b';');
    let values: Vec<f64> = cells
        .iter()
        .filter_map(|cell| parse_number(&decimals.with_point(0, cell.as_bytes())).ok())
        .collect();
    (!values.is_empty() && looks_serial(header, &values)).then_some("excel")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_times_and_days_of_a_sheet_are_told_apart() {
        let of = |header: &str, cells: &[&str]| written_time(header, cells);
        assert_eq!(of("a", &["2024-05-01 12:00:00", "2024-05-01 12:00:01"]), Some("timestamp"));
        assert_eq!(of("a", &["12:00:00", "12:00:01"]), Some("hh:mm:ss"));
        assert_eq!(of("time", &["45413.5", "45413.50001"]), Some("excel"));
        assert_eq!(of("a", &["1.0", "2.0"]), None);
        assert_eq!(of("date", &["2024-05-01"; 5]), None);
    }
}
