//! Times for people.

/// Formats a time, µs since 1970, as `2026-11-21 10:06` UTC; the civil calendar from days, after
/// Howard Hinnant.
pub(crate) fn format_date(us: i64) -> String {
    let seconds = us.div_euclid(1_000_000);
    let (days, second) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
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
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}", second / 3600, second / 60 % 60)
}

#[cfg(test)]
mod tests {
    use super::format_date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(format_date(0), "1970-01-01 00:00");
        assert_eq!(format_date(951_782_400_000_000), "2000-02-29 00:00");
        assert_eq!(format_date(1_798_761_599_000_000), "2026-12-31 23:59");
        assert_eq!(format_date(1_800_000_000_000_000), "2027-01-15 08:00");
    }
}
