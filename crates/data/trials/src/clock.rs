//! Conversion of the time column: seconds, serial days, or dates and times of day, to seconds since
//! the first row.

use crate::calendar::{SECOND, format_iso};
use crate::findings::Findings;
use crate::number::{CellFault, parse_number, shown_text};
use crate::open_dates::OpenDates;
use crate::stamp::{DateOrder, StampDate, TimeStamp, parse_stamp};
use crate::table::{ColumnTarget, Table, TableColumn, TimeOrigin};

/// Decrease of a time of day, ns, from which the row belongs to the next day; with less it is out
/// of order.
const MIDNIGHT: i64 = 12 * 3600 * SECOND;
/// Seconds of a day.
const DAY_S: f64 = 86_400.0;
/// Origin of the day numbers of Excel and of MATLAB, in days since 1970.
const EXCEL: f64 = -25_569.0;
const MATLAB: f64 = -719_529.0;
/// Range of numbers that may be days of Excel (years 1954 to 2118), and their largest average step,
/// days: seconds since midnight are as large, but further apart.
const SERIAL: std::ops::Range<f64> = 20_000.0..80_000.0;
const SERIAL_STEP: f64 = 0.002;

/// Units of a time column that is written as text, whether declared or detected.
const WRITTEN: [&str; 5] = ["auto", "timestamp", "day/month/year", "month/day/year", "hh:mm:ss"];

/// Reader of the cells of the time column, in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct ColumnClock {
    unit: String,
    /// Form of the first cell, which all others must share.
    form: Option<TimeForm>,
    /// First day; days are counted from it to keep the numbers small.
    first_day: i64,
    /// Time of day of the previous row, ns, and midnights since the first row.
    before: i64,
    midnights: i64,
    open: OpenDates,
    /// Number of the first row in SI units, where rows are converted one by one.
    origin: Option<f64>,
    /// Start of a table whose time is already in seconds.
    counted: Option<TimeOrigin>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TimeForm {
    Number,
    Dated { zoned: bool },
    OpenDate { zoned: bool },
    OfDay,
}

impl ColumnClock {
    /// Creates the clock for the columns of a file, one of which is time.
    pub(crate) fn from_columns(columns: &[TableColumn]) -> Self {
        let time = columns.iter().find(|column| column.target == ColumnTarget::Time);
        Self { unit: time.map_or(String::new(), |column| column.unit.clone()), ..Self::default() }
    }

    /// Creates the clock of a table whose time is already in seconds.
    pub(crate) fn with_start(start: Option<TimeOrigin>) -> Self {
        Self { counted: start, ..Self::default() }
    }

    fn is_written(&self) -> bool {
        WRITTEN.contains(&self.unit.as_str())
    }

    /// Converts a cell to a number: as written, or seconds since midnight of the first row's day.
    pub(crate) fn read_cell(&mut self, row: usize, cell: &[u8]) -> Result<f64, CellFault> {
        let plain = parse_number(cell);
        if !self.is_written() || matches!(plain, Err(CellFault::Empty | CellFault::NotANumber)) {
            return plain;
        }
        let stamp =
            std::str::from_utf8(cell).ok().and_then(|text| parse_stamp(text, self.date_order()));
        // With unit `auto` a plain number wins over a date such as 20240501.
        let form = match (&plain, stamp) {
            (Ok(_), _) if self.unit == "auto" => TimeForm::Number,
            (_, Some(stamp)) => TimeForm::from_stamp(stamp),
            _ => return Err(CellFault::NoTime(shown_text(cell))),
        };
        // All cells must have the form of the first.
        let first = self.form.is_none();
        let fits = form == *self.form.get_or_insert(form);
        if !fits || (self.unit == "hh:mm:ss" && form != TimeForm::OfDay) {
            return Err(CellFault::OtherTime(shown_text(cell)));
        }
        stamp.map_or(plain, |stamp| Ok(self.stamp_seconds(row, stamp, first)))
    }

    fn date_order(&self) -> DateOrder {
        match self.unit.as_str() {
            "day/month/year" => DateOrder::DayFirst,
            "month/day/year" => DateOrder::MonthFirst,
            _ => DateOrder::Open,
        }
    }

    fn stamp_seconds(&mut self, row: usize, stamp: TimeStamp, first: bool) -> f64 {
        let day = match stamp.date {
            StampDate::Known(day) => day,
            StampDate::Either(date) => self.open.date_code(row, date),
            // A time of day without a date: a large decrease means that midnight has passed.
            StampDate::Absent => {
                self.midnights += i64::from(!first && self.before - stamp.of_day > MIDNIGHT);
                self.before = stamp.of_day;
                self.midnights
            }
        };
        if first {
            self.first_day = day;
        }
        stamp.seconds_after(day - self.first_day)
    }

    /// Returns the time in the table, s, of a number in SI units; `None` if it depends on the whole
    /// column. To be called for every row, from the first on.
    pub(crate) fn seconds_since_start(&mut self, value: f64) -> Option<f64> {
        let origin = *self.origin.get_or_insert(value);
        match self.form.unwrap_or(TimeForm::Number) {
            TimeForm::OpenDate { .. } => None,
            // Numbers in the range of Excel's days are only known from the whole column.
            TimeForm::Number if self.unit == "auto" => (!SERIAL.contains(&origin)).then_some(value),
            TimeForm::Number if !is_serial(&self.unit) => Some(value),
            _ => Some(value - origin),
        }
    }

    /// Returns true if the times can only be read once the whole column is known.
    pub(crate) fn is_open(&self) -> bool {
        match self.form {
            Some(TimeForm::OpenDate { .. }) => true,
            Some(TimeForm::Number) | None => {
                let is_day = |origin: f64| SERIAL.contains(&origin);
                self.unit == "auto" && self.origin.is_some_and(is_day)
            }
            _ => false,
        }
    }

    /// Returns the calendar time of time zero, once the first row is read.
    pub(crate) fn time_zero(&self) -> Option<TimeOrigin> {
        self.counted.clone().or_else(|| self.calendar_start(self.origin?))
    }

    fn calendar_start(&self, first: f64) -> Option<TimeOrigin> {
        match self.form.unwrap_or(TimeForm::Number) {
            TimeForm::Dated { zoned } => Some(calendar_instant(self.first_day, first, zoned)),
            TimeForm::OfDay => {
                let mut start = calendar_instant(0, first, false);
                // Only the time of day is known: the date is removed from the text.
                start.text = start.text.split_off("1970-01-01T".len());
                start.dated = false;
                Some(start)
            }
            TimeForm::Number if is_serial(&self.unit) => self.calendar_days(first).1,
            _ => None,
        }
    }

    /// Converts the time of the table to seconds since its first row, and reports the form that was
    /// read.
    pub(crate) fn rebase_table(&mut self, table: &mut Table, findings: &mut Findings) {
        let Some(at) = table.columns.iter().position(|column| column.target == ColumnTarget::Time)
        else {
            return;
        };
        let (header, values) = (table.columns[at].header.clone(), &mut table.values[at]);
        if values.is_empty() || !(self.is_written() || is_serial(&self.unit)) {
            return;
        }
        let read = self.convert_values(&header, values).and_then(|read| {
            // Differences of extreme times may not be finite.
            let counted = values.iter().all(|value| value.is_finite());
            counted.then_some(read).ok_or_else(|| "has times that are too far apart".into())
        });
        match read {
            Ok((form, start)) => {
                let from =
                    start.as_ref().map_or(String::new(), |start| format!(", {}", start.text));
                let message = format!("is read as {form}, relative to its first row{from}");
                findings.warning(None, Some(&header), message);
                table.start = start;
            }
            Err(message) => findings.error(None, Some(&header), message),
        }
    }

    /// Converts the numbers to seconds since the first; returns their form, and the calendar time
    /// of the first.
    fn convert_values(
        &mut self,
        header: &str,
        values: &mut [f64],
    ) -> Result<(&'static str, Option<TimeOrigin>), String> {
        let first = self.origin.unwrap_or(values[0]);
        let start = self.calendar_start(first);
        match self.form.unwrap_or(TimeForm::Number) {
            TimeForm::Number => Ok(self.convert_numbers(header, values, first)),
            TimeForm::Dated { zoned } => {
                subtract_first(values, first, 1e9);
                Ok((Self::date_form(zoned), start))
            }
            TimeForm::OpenDate { zoned } => {
                let first_day = self.open.convert_days(self.first_day, values)?;
                let start = calendar_instant(first_day, values[0], zoned);
                let first = values[0];
                subtract_first(values, first, 1e6);
                Ok((Self::date_form(zoned), Some(start)))
            }
            TimeForm::OfDay => {
                subtract_first(values, first, 1e9);
                Ok(("time of day", start))
            }
        }
    }

    fn date_form(zoned: bool) -> &'static str {
        if zoned { "date and time with a zone" } else { "date and time without a zone" }
    }

    fn convert_numbers(
        &self,
        header: &str,
        values: &mut [f64],
        mut first: f64,
    ) -> (&'static str, Option<TimeOrigin>) {
        let is_auto = self.unit == "auto";
        // Rows that were converted one by one are in seconds already.
        if is_auto && (self.origin.is_some() || !looks_serial(header, values)) {
            return ("seconds, as no unit is declared", None);
        }
        if is_auto {
            values.iter_mut().for_each(|value| *value *= DAY_S);
            first *= DAY_S;
        }
        subtract_first(values, first, 1e6);
        self.calendar_days(first)
    }

    /// Returns the name of the calendar in which days or seconds are counted, and the start.
    fn calendar_days(&self, first: f64) -> (&'static str, Option<TimeOrigin>) {
        let (name, epoch) = match self.unit.as_str() {
            "matlab" => ("MATLAB's days", MATLAB),
            "unix" => ("seconds since 1970", 0.0),
            _ => ("Excel's days", EXCEL),
        };
        let start = first + epoch * DAY_S;
        // Outside the years that are read, no start is given.
        let known = (-2.2e9..5.7e9).contains(&start);
        let start = known.then(|| calendar_instant(0, (start * 1e6).round() / 1e6, false));
        (name, start)
    }
}

impl TimeForm {
    fn from_stamp(stamp: TimeStamp) -> Self {
        let zoned = stamp.zone.is_some();
        match stamp.date {
            StampDate::Known(_) => Self::Dated { zoned },
            StampDate::Either(_) => Self::OpenDate { zoned },
            StampDate::Absent => Self::OfDay,
        }
    }
}

fn is_serial(unit: &str) -> bool {
    matches!(unit, "excel" | "matlab" | "unix")
}

/// Returns true if numbers without a unit can only be days of Excel, by header, size and step.
pub(crate) fn looks_serial(header: &str, values: &[f64]) -> bool {
    let name = header.to_lowercase();
    let step = (values[values.len() - 1] - values[0]) / values.len() as f64;
    ["date", "time", "utc"].iter().any(|word| name.contains(word))
        && values.iter().all(|value| SERIAL.contains(value))
        && step < SERIAL_STEP
}

/// Subtracts the first value and rounds to the given number of parts of a second, the resolution of
/// the form.
fn subtract_first(values: &mut [f64], first: f64, parts: f64) {
    values.iter_mut().for_each(|value| *value = ((*value - first) * parts).round() / parts);
}

fn calendar_instant(day: i64, seconds: f64, zoned: bool) -> TimeOrigin {
    let whole = seconds.floor();
    // Rounded to microseconds, in nanoseconds.
    let fraction = ((seconds - whole) * 1e6).round() * 1e3;
    let nanoseconds = (whole as i64 + day * 86_400) * SECOND + fraction as i64;
    let text = format!("{}{}", format_iso(nanoseconds), if zoned { "Z" } else { "" });
    TimeOrigin { text, at_s: day as f64 * DAY_S + seconds, dated: true }
}

#[cfg(test)]
#[path = "clock_tests.rs"]
mod tests;
