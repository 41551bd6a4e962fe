//! Dates such as 05/01/2024, of which only the whole column tells which number is the month.

use crate::calendar::day;

/// Two numbers of which one is the month, and the year.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct OpenDate {
    pub first: i64,
    pub second: i64,
    pub year: i64,
}

/// Days that a date is kept apart from the next by, so that a zone can move its hours beyond
/// midnight.
const APART: i64 = 4;
const DAY_S: f64 = 86_400.0;

/// What the rows of a column have told of the order.
#[derive(Debug, Default)]
pub(crate) struct OpenDates {
    /// Rows in which the first or the second number is no month.
    first_is_day: Option<usize>,
    second_is_day: Option<usize>,
}

impl OpenDates {
    /// A number for the date, in days, from which the date can be had back.
    pub(crate) fn slot(&mut self, row: usize, date: OpenDate) -> i64 {
        if date.first > 12 {
            self.first_is_day.get_or_insert(row);
        }
        if date.second > 12 {
            self.second_is_day.get_or_insert(row);
        }
        ((date.year * 100 + date.first) * 100 + date.second) * APART
    }

    /// Turns seconds by such numbers into seconds by days; the day of the first.
    pub(crate) fn days(&self, first_slot: i64, values: &mut [f64]) -> Result<i64, String> {
        let day_first = self.day_first()?;
        let first = known(first_slot / APART, day_first)?;
        let width = APART as f64 * DAY_S;
        for value in values {
            let slot = ((*value + DAY_S) / width).floor();
            let day = known(first_slot / APART + slot as i64, day_first)?;
            *value += (day - first) as f64 * DAY_S - slot * width;
        }
        Ok(first)
    }

    fn day_first(&self) -> Result<bool, String> {
        match (self.first_is_day, self.second_is_day) {
            (Some(_), None) => Ok(true),
            (None, Some(_)) => Ok(false),
            (None, None) => {
                Err("day and month cannot be told apart anywhere in this column; declare its unit \
                                 as `day/month/year` or `month/day/year`"
                    .into())
            }
            (Some(one), Some(other)) => Err(format!(
                "row {one} has the day before the month, row {other} has it after; write dates \
                as 2024-05-31"
            )),
        }
    }
}

fn known(slot: i64, day_first: bool) -> Result<i64, String> {
    let (year, first, second) = (slot / 10_000, slot / 100 % 100, slot % 100);
    let (month, of_month) = if day_first { (second, first) } else { (first, second) };
    day(year, month, of_month)
        .ok_or_else(|| format!("there is no {year:04}-{month:02}-{of_month:02}; correct the date"))
}
