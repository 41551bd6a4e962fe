//! Times for people.

use crate::language::Language;

/// Formats a time, µs since 1970, as `2026-11-21 10:06` UTC, in German and Norwegian as
/// `21.11.2026 10:06`.
pub(crate) fn format_date(us: i64) -> String {
    let second = us.div_euclid(1_000_000).rem_euclid(86_400);
    format!("{} {:02}:{:02}", format_day(us), second / 3600, second / 60 % 60)
}

/// Formats the day of a time, µs since 1970.
pub(crate) fn format_day(us: i64) -> String {
    let (year, month, day) = civil_date(us.div_euclid(86_400_000_000));
    write_day(year, month, day)
}

/// Formats a day that is stored as `2026-11-21`; another text stays as it is.
pub(crate) fn format_stored_day(text: &str) -> String {
    let parts: Vec<i64> = text.split('-').filter_map(|part| part.parse().ok()).collect();
    match parts.as_slice() {
        [year, month, day] => write_day(*year, *month, *day),
        _ => text.to_owned(),
    }
}

fn write_day(year: i64, month: i64, day: i64) -> String {
    match Language::current() {
        Language::English => format!("{year:04}-{month:02}-{day:02}"),
        Language::German | Language::Norwegian => format!("{day:02}.{month:02}.{year:04}"),
    }
}

/// Returns year, month and day of the civil calendar from days since 1970, after Howard Hinnant.
fn civil_date(days: i64) -> (i64, i64, i64) {
    // Days since 1 March of the year 0; an era is 400 years of 146097 days, and years begin in
    // March, so that the leap day is their last.
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let (day, month) = (
        day_of_year - (153 * from_march + 2) / 5 + 1,
        from_march + if from_march < 10 { 3 } else { -9 },
    );
    (year_of_era + era * 400 + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::{format_date, format_stored_day};
    use crate::language::Language;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(format_date(0), "1970-01-01 00:00");
        assert_eq!(format_date(951_782_400_000_000), "2000-02-29 00:00");
        assert_eq!(format_date(1_798_761_599_000_000), "2026-12-31 23:59");
        assert_eq!(format_date(1_800_000_000_000_000), "2027-01-15 08:00");
    }

    #[test]
    fn the_day_comes_first_in_german() {
        let date = Language::German.run_blocking(|| format_date(1_798_761_599_000_000));
        assert_eq!(date, "31.12.2026 23:59");
        let stored = |text| Language::Norwegian.run_blocking(|| format_stored_day(text));
        assert_eq!(
            (stored("2026-11-29"), stored("in May")),
            ("29.11.2026".into(), "in May".into())
        );
    }
}
