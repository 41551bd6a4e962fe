//! Parsing of dates and times of day in common forms.

use crate::calendar::{SECOND, day_of_date};
use crate::open_dates::OpenDate;

/// Order of day and month before the year.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DateOrder {
    DayFirst,
    MonthFirst,
    /// Not known until the whole column is read.
    Open,
}

/// Date of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StampDate {
    /// Days since 1970.
    Known(i64),
    /// Two numbers, one of which is the month, and the year.
    Either(OpenDate),
    /// No date, only a time of day.
    Absent,
}

/// Content of a cell of a time column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TimeStamp {
    pub date: StampDate,
    /// Nanoseconds since midnight, as written.
    pub of_day: i64,
    /// Offset of the time zone from UTC, ns, positive to the east, if one is written.
    pub zone: Option<i64>,
}

const MONTHS: [&str; 12] =
    ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

/// Parses a date with time of day, or a time of day.
pub(crate) fn parse_stamp(text: &str, order: DateOrder) -> Option<TimeStamp> {
    let text = text.trim();
    // No time is longer, and the slices below require ASCII.
    if text.len() > 48 || !text.is_ascii() {
        return None;
    }
    let (date, time) = split_date(text);
    let (time, zone) = split_zone(time)?;
    let (time, half) = split_half_day(time.trim());
    let of_day = parse_day_time(time, half)?;
    let date = if date.is_empty() { StampDate::Absent } else { self::parse_date(date, order)? };
    Some(TimeStamp { date, of_day, zone })
}

/// Splits a text into date and time of day, separated by `T`, blanks or a comma.
fn split_date(text: &str) -> (&str, &str) {
    let colon = text.find(':').unwrap_or(text.len());
    match text[..colon].rfind([' ', 'T', 't', ',', '_']) {
        Some(at) => (text[..at].trim_matches([' ', ',']), &text[at + 1..]),
        None => ("", text),
    }
}

/// Splits a time into the time without its zone, and the zone: `Z`, `UTC`, `GMT`, `+02:00`, `-0330`
/// or `+02`.
fn split_zone(time: &str) -> Option<(&str, Option<i64>)> {
    for name in ["Z", "z", "UTC", "GMT"] {
        if let Some(rest) = time.strip_suffix(name) {
            return Some((rest, Some(0)));
        }
    }
    let Some(at) = time.find(['+', '-']) else { return Some((time, None)) };
    let digits: String = time[at + 1..].chars().filter(|&c| c != ':').collect();
    let (hours, minutes) = match digits.len() {
        2 => (parse_digits(&digits)?, 0),
        4 => (parse_digits(&digits[..2])?, parse_digits(&digits[2..])?),
        _ => return None,
    };
    let sign = if time.as_bytes()[at] == b'-' { -1 } else { 1 };
    let fits = hours <= 15 && minutes < 60;
    fits.then(|| (&time[..at], Some(sign * (hours * 60 + minutes) * 60 * SECOND)))
}

/// Splits a time into the time without `AM` or `PM`, and the presence of either: true for `PM`.
fn split_half_day(time: &str) -> (&str, Option<bool>) {
    let cut = |name: &str| {
        let at = time.len().checked_sub(name.len())?;
        time[at..].eq_ignore_ascii_case(name).then(|| time[..at].trim_end())
    };
    match (cut("am"), cut("pm")) {
        (Some(rest), _) => (rest, Some(false)),
        (_, Some(rest)) => (rest, Some(true)),
        _ => (time, None),
    }
}

/// Returns the nanoseconds since midnight of `hh:mm`, `hh:mm:ss`, `hh:mm:ss.sss` or `hh:mm:ss,sss`.
fn parse_day_time(time: &str, half: Option<bool>) -> Option<i64> {
    let mut parts = time.split(':');
    let (hour, minute) = (parse_digits(parts.next()?)?, parse_digits(parts.next()?)?);
    let seconds = parts.next().map_or(Some(0), parse_seconds)?;
    let hour = match half {
        None => hour,
        Some(_) if !(1..=12).contains(&hour) => return None,
        Some(after) => hour % 12 + if after { 12 } else { 0 },
    };
    // A leap second has the number 60.
    let fits = parts.next().is_none() && hour < 24 && minute < 60 && seconds < 61 * SECOND;
    fits.then_some((hour * 60 + minute) * 60 * SECOND + seconds)
}

fn parse_seconds(text: &str) -> Option<i64> {
    let (seconds, fraction) = text.split_once(['.', ',']).unwrap_or((text, ""));
    if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    // Padded with zeros or cut to nine digits, hence nanoseconds.
    let digits = format!("{:0<9.9}", fraction);
    Some(parse_digits(seconds)? * SECOND + digits.parse::<i64>().ok()?)
}

/// Parses one to four digits and nothing else.
fn parse_digits(text: &str) -> Option<i64> {
    let digits = (1..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    if digits { text.parse().ok() } else { None }
}

fn parse_date(text: &str, order: DateOrder) -> Option<StampDate> {
    let mark = text.chars().find(|c| matches!(c, '-' | '/' | '.' | ' '))?;
    let parts: Vec<&str> = text.split(mark).collect();
    let &[one, two, three] = parts.as_slice() else { return None };
    if one.len() == 4 {
        return Some(StampDate::Known(day_of_date(
            parse_digits(one)?,
            parse_month(two)?,
            parse_digits(three)?,
        )?));
    }
    // Two digits after hyphens may be a day with the year in front: ambiguous, and refused.
    if three.len() == 2 && mark == '-' && parse_digits(two).is_some() {
        return None;
    }
    let (year, first) = (parse_year(three)?, parse_digits(one)?);
    let (Some(second), true) = (parse_digits(two), matches!(mark, '/' | '-')) else {
        // With points or names of months the day comes first in all common forms.
        return Some(StampDate::Known(day_of_date(year, parse_month(two)?, first)?));
    };
    match order {
        DateOrder::DayFirst => Some(StampDate::Known(day_of_date(year, second, first)?)),
        DateOrder::MonthFirst => Some(StampDate::Known(day_of_date(year, first, second)?)),
        DateOrder::Open => {
            let fits = day_of_date(year, second, first)
                .or_else(|| day_of_date(year, first, second))
                .is_some();
            fits.then_some(StampDate::Either(OpenDate { first, second, year }))
        }
    }
}

/// Parses a year of four digits, or of two: those from 69 on are 19xx, the others 20xx
/// (POSIX.1-2017, `strptime`, `%y`).
fn parse_year(text: &str) -> Option<i64> {
    match (text.len(), parse_digits(text)?) {
        (4, year) => Some(year),
        (2, year) => Some(if year < 69 { 2000 + year } else { 1900 + year }),
        _ => None,
    }
}

fn parse_month(text: &str) -> Option<i64> {
    let named = MONTHS.iter().zip(1..).find(|(name, _)| text.eq_ignore_ascii_case(name));
    named.map_or_else(|| parse_digits(text), |(_, number)| Some(number))
}

impl TimeStamp {
    /// Returns seconds in UTC since midnight of a reference day that is `days` days earlier.
    pub(crate) fn seconds_after(self, days: i64) -> f64 {
        let of_day = self.of_day - self.zone.unwrap_or(0);
        days as f64 * 86_400.0 + of_day as f64 / SECOND as f64
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::calendar::format_iso;

    fn read(text: &str) -> String {
        let stamp = parse_stamp(text, DateOrder::Open).unwrap();
        match stamp.date {
            StampDate::Known(day) => {
                format_iso((stamp.seconds_after(day) * 1e3).round() as i64 * 1_000_000)
            }
            StampDate::Absent => format_iso((stamp.seconds_after(0) * 1e3) as i64 * 1_000_000)
                .replace("1970-01-01", ""),
            StampDate::Either(date) => format!("{}|{}|{}", date.first, date.second, date.year),
        }
    }

    #[test]
    fn common_forms_are_read() {
        for (text, wanted) in [
            ("2024-05-01T12:00:03.250Z", "2024-05-01T12:00:03.25"),
            ("2024-05-01 12:00:03,25", "2024-05-01T12:00:03.25"),
            ("2024-05-01T12:00:03+02:00", "2024-05-01T10:00:03"),
            ("2024-05-01T01:00:03+0230", "2024-04-30T22:30:03"),
            ("01.05.2024 12:00:03", "2024-05-01T12:00:03"),
            ("2024/05/01 12:00", "2024-05-01T12:00:00"),
            ("01-May-2024 12:00:03", "2024-05-01T12:00:03"),
            ("05/01/2024 12:00:03 PM", "5|1|2024"),
            ("01.05.24 12:00:03", "2024-05-01T12:00:03"),
            ("01-May-98 12:00", "1998-05-01T12:00:00"),
            ("05/01/24 12:00", "5|1|2024"),
            ("12:00:03.5", "T12:00:03.5"),
            ("12:00:03 AM", "T00:00:03"),
            ("23:59:60", "1970-01-02T00:00:00"),
        ] {
            assert_eq!(read(text), wanted, "{text}");
        }
    }

    #[test]
    fn what_is_no_time_is_none() {
        for text in [
            "",
            "12",
            "12:",
            ":",
            "12:61",
            "25:00",
            "2024-02-30 12:00",
            "2024-05-01",
            "1:2:3:4",
            "13/13/2024 12:00",
            "01-05-24 12:00",
            "01.05.124 12:00",
            "13:00 PM",
            "12:00:0x",
            "T",
            "+",
            "12:00+99",
            "1\u{e9}:00",
            "99999:00",
            "12:00:00.1.2",
        ] {
            assert_eq!(parse_stamp(text, DateOrder::Open), None, "{text}");
        }
    }
}
