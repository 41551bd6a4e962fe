#![allow(clippy::unwrap_used)]
use super::*;
use crate::testing::finding_messages;

fn read(header: &str, unit: &str, cells: &[&str]) -> (Vec<f64>, Option<String>, String) {
    let to_si = crate::units::UnitKind::Time.unit_to_si(unit).unwrap();
    let column = TableColumn {
        index: 0,
        header: header.into(),
        target: ColumnTarget::Time,
        unit: unit.into(),
        to_si,
        at_rest: 0.0,
    };
    let mut clock = ColumnClock::from_columns(std::slice::from_ref(&column));
    let (mut values, mut faults) = (Vec::new(), String::new());
    for (row, cell) in (2..).zip(cells) {
        match clock.read_cell(row, cell.as_bytes()) {
            Ok(value) => values.push(value * to_si),
            Err(fault) => faults += &format!("row {row}: {fault}\n"),
        }
    }
    let mut table = Table { columns: vec![column], values: vec![values], ..Table::default() };
    let mut findings = Findings::default();
    clock.rebase_table(&mut table, &mut findings);
    (
        table.values.remove(0),
        table.start.map(|start| start.text),
        faults + &finding_messages(findings),
    )
}

fn seconds(unit: &str, cells: &[&str], wanted: &[f64], start: &str) {
    let (values, from, text) = read("Date/Time", unit, cells);
    assert_eq!((values.as_slice(), from.as_deref()), (wanted, Some(start)), "{text}");
    assert!(text.starts_with("warning") && text.contains("is read as"), "{text}");
}

#[test]
fn dates_and_times_become_seconds_since_the_first_row() {
    let cells =
        ["2024-05-01T12:00:03.250Z", "2024-05-01T12:00:03.350Z", "2024-05-02T12:00:03.250Z"];
    seconds("auto", &cells, &[0.0, 0.1, 86_400.0], "2024-05-01T12:00:03.25Z");
    let cells = ["2024-05-01T01:00:00+02:00", "2024-04-30T23:00:01Z"];
    seconds("timestamp", &cells, &[0.0, 1.0], "2024-04-30T23:00:00Z");
    let cells = ["01.05.2024 12:00:03", "01.05.2024 12:00:04"];
    seconds("timestamp", &cells, &[0.0, 1.0], "2024-05-01T12:00:03");
}

#[test]
fn a_time_of_day_goes_over_midnight() {
    let cells = ["23:59:59.5", "00:00:00.5", "00:00:00.25"];
    seconds("hh:mm:ss", &cells, &[0.0, 1.0, 0.75], "23:59:59.5");
    assert!(read("t", "hh:mm:ss", &["2024-05-01 12:00:00"]).2.contains("row 2"));
}

#[test]
fn days_and_months_are_told_apart_by_the_whole_column_or_not_at_all() {
    let cells = ["05/12/2024 11:59:59 PM", "05/13/2024 12:00:01 AM"];
    seconds("auto", &cells, &[0.0, 2.0], "2024-05-12T23:59:59");
    let cells = ["31/05/2024 23:00:00+02:00", "01/06/2024 00:00:00+02:00"];
    seconds("auto", &cells, &[0.0, 3600.0], "2024-05-31T21:00:00Z");
    let text = read("t", "auto", &["05/01/2024 12:00:03", "05/01/2024 12:00:04"]).2;
    assert!(text.contains("declare its unit as `day/month/year` or"), "{text}");
    let cells = ["05/01/2024 12:00:03", "06/01/2024 12:00:03"];
    seconds("day/month/year", &cells, &[0.0, 86_400.0], "2024-01-05T12:00:03");
    seconds("month/day/year", &cells, &[0.0, 31.0 * 86_400.0], "2024-05-01T12:00:03");
    let text = read("t", "auto", &["13/05/2024 12:00:03", "05/13/2024 12:00:03"]).2;
    assert!(text.contains("row 2 has the day before the month, row 3"), "{text}");
}

#[test]
fn serial_days_are_declared_or_recognised() {
    let cells = ["45413.5", "45413.500011574074"];
    seconds("excel", &cells, &[0.0, 1.0], "2024-05-01T12:00:00");
    seconds("auto", &cells, &[0.0, 1.0], "2024-05-01T12:00:00");
    seconds("matlab", &["739373.5", "739373.75"], &[0.0, 21_600.0], "2024-05-01T12:00:00");
    seconds("unix", &["1714564800", "1714564800.5"], &[0.0, 0.5], "2024-05-01T12:00:00");
    let (values, start, text) = read("time", "auto", &["43200.0", "43200.5"]);
    assert_eq!((values, start), (vec![43_200.0, 43_200.5], None));
    assert!(text.contains("seconds, as no unit is declared"));
}

#[test]
fn what_is_not_of_the_columns_form_is_named() {
    let text = read("time", "auto", &["12:00:00", "abc", "5", "2024-05-01 12:00:00", ""]).2;
    for row in ["row 3: `abc`", "row 4: `5`", "row 5: `2024-05-01", "row 6: the cell is empty"] {
        assert!(text.contains(row), "{text}");
    }
    assert!(read("t_s", "s", &["12:00:00"]).2.contains("hh:mm:ss"));
}
