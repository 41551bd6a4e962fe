//! Days of the Gregorian calendar, counted from 1 January 1970.

/// Number of days before each month of a common year.
const BEFORE: [i64; 12] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334];
/// Days from 1 January of the year 1 to 1 January 1970.
const EPOCH: i64 = 719_162;

/// Nanoseconds of a second and of a day.
pub(crate) const SECOND: i64 = 1_000_000_000;
pub(crate) const DAY: i64 = 86_400 * SECOND;

fn is_leap(year: i64) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

/// Day number of 1 January, counted from 1 January 1970.
fn year_start(year: i64) -> i64 {
    let past = year - 1;
    365 * past + past / 4 - past / 100 + past / 400 - EPOCH
}

fn month_start(year: i64, month: i64) -> i64 {
    let index = usize::try_from(month - 1).unwrap_or(0).min(11);
    year_start(year) + BEFORE[index] + i64::from(month > 2 && is_leap(year))
}

/// Years that are read: no trial is older, and the nanoseconds between them fit 64 bits.
const YEARS: std::ops::RangeInclusive<i64> = 1900..=2150;

/// Returns the day of a date, counted from 1970; `None` for a date that does not exist or is out of
/// range.
pub(crate) fn day_of_date(year: i64, month: i64, of_month: i64) -> Option<i64> {
    if !YEARS.contains(&year) || !(1..=12).contains(&month) || of_month < 1 {
        return None;
    }
    let start = month_start(year, month);
    let next = if month == 12 { year_start(year + 1) } else { month_start(year, month + 1) };
    (of_month <= next - start).then_some(start + of_month - 1)
}

/// Returns year, month and day of the month.
pub(crate) fn date_of_day(day: i64) -> (i64, i64, i64) {
    // Division by 366 never overestimates the year; the loop corrects the rest.
    let mut year = (day + EPOCH) / 366 + 1;
    while year_start(year + 1) <= day {
        year += 1;
    }
    let month = (1..=12).rev().find(|&month| month_start(year, month) <= day).unwrap_or(1);
    (year, month, day - month_start(year, month) + 1)
}

/// Formats nanoseconds since 1970 as `2024-05-01T12:00:03.25`.
pub(crate) fn format_iso(instant: i64) -> String {
    let ((year, month, of_month), rest) =
        (date_of_day(instant.div_euclid(DAY)), instant.rem_euclid(DAY));
    let seconds = rest / SECOND;
    let fraction = format!("{:09}", rest % SECOND);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{of_month:02}T{hour:02}:{minute:02}:{second:02}{point}{fraction}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_and_dates_are_each_others_inverse() {
        assert_eq!(day_of_date(1970, 1, 1), Some(0));
        assert_eq!(day_of_date(2024, 5, 1), Some(19_844));
        assert_eq!((day_of_date(1900, 1, 1), day_of_date(1899, 12, 30)), (Some(-25_567), None));
        assert_eq!(
            (day_of_date(2023, 2, 29), day_of_date(2024, 2, 30), day_of_date(2024, 13, 1)),
            (None, None, None)
        );
        for at in (-25_567..65_000).step_by(17) {
            let (year, month, of_month) = date_of_day(at);
            assert_eq!(day_of_date(year, month, of_month), Some(at));
        }
    }

    #[test]
    fn instants_are_written_as_iso_8601() {
        let noon = 19_844 * DAY + (12 * 3600 + 3) * SECOND;
        assert_eq!(format_iso(noon), "2024-05-01T12:00:03");
        assert_eq!(format_iso(noon + SECOND / 4), "2024-05-01T12:00:03.25");
        assert_eq!(format_iso(-SECOND), "1969-12-31T23:59:59");
    }
}
