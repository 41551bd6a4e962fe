//! Dates such as 05/01/2024, whose order of day and month is only known from the whole column.

use crate::calendar::day_of_date;

/// Date of two numbers, one of which is the month, and the year.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct OpenDate {
    pub first: i64,
    pub second: i64,
    pub year: i64,
}

/// Number of days between consecutive codes, so that a time zone can move the hours beyond midnight
/// without reaching another code.
const APART: i64 = 4;
const DAY_S: f64 = 86_400.0;

/// Evidence of the rows of a column on the order of day and month.
#[derive(Debug, Default)]
pub(crate) struct OpenDates {
    /// Row in which the first, and the second, number cannot be a month.
    first_is_day: Option<usize>,
    second_is_day: Option<usize>,
}

impl OpenDates {
    /// Returns a code for the date, in days, from which the date can be recovered.
    pub(crate) fn date_code(&mut self, row: usize, date: OpenDate) -> i64 {
        if date.first > 12 {
            self.first_is_day.get_or_insert(row);
        }
        if date.second > 12 {
            self.second_is_day.get_or_insert(row);
        }
        ((date.year * 100 + date.first) * 100 + date.second) * APART
    }

    /// Converts seconds that count codes to seconds that count days; returns the day of the first.
    pub(crate) fn convert_days(&self, first_slot: i64, values: &mut [f64]) -> Result<i64, String> {
        let day_first = self.day_first()?;
        let first = day_of_code(first_slot / APART, day_first)?;
        let width = APART as f64 * DAY_S;
        for value in values {
            // The offset by one day keeps times that a zone has moved to the day before in their
            // own code.
            let slot = ((*value + DAY_S) / width).floor();
            let day = day_of_code(first_slot / APART + slot as i64, day_first)?;
            *value += (day - first) as f64 * DAY_S - slot * width;
        }
        Ok(first)
    }

    fn day_first(&self) -> Result<bool, String> {
        match (self.first_is_day, self.second_is_day) {
            (Some(_), None) => Ok(true),
            (None, Some(_)) => Ok(false),
            (None, None) => {
                Err("day and month cannot be distinguished in this column; declare its unit as \
                     `day/month/year` or `month/day/year`"
                    .into())
            }
            (Some(one), Some(other)) => Err(format!(
                "row {one} has the day before the month, row {other} after it; write dates as \
                 2024-05-31"
            )),
        }
    }
}

fn day_of_code(slot: i64, day_first: bool) -> Result<i64, String> {
    let (year, first, second) = (slot / 10_000, slot / 100 % 100, slot % 100);
    let (month, of_month) = if day_first { (second, first) } else { (first, second) };
    day_of_date(year, month, of_month)
        .ok_or_else(|| format!("{year:04}-{month:02}-{of_month:02} is not a date; correct it"))
}
