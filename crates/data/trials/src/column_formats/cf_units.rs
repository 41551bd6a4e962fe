//! Units, scales and times by the Climate and Forecast conventions, which NetCDF files follow.

use crate::calendar::SECOND;
use crate::stamp::{DateOrder, StampDate, parse_stamp};

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;
/// Spellings of units that are usual in these files only.
const SPELLINGS: [(&str, &str); 10] = [
    ("degrees_north", "deg"),
    ("degrees_east", "deg"),
    ("degree_north", "deg"),
    ("degree_east", "deg"),
    ("degrees_true", "deg"),
    ("degree_true", "deg"),
    ("radian", "rad"),
    ("rad s-1", "rad/s"),
    ("degree s-1", "deg/s"),
    ("degrees/second", "deg/s"),
];

/// Time since an epoch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CfTime {
    /// Seconds of the unit.
    pub unit_s: f64,
    /// Seconds of the epoch since 1970.
    pub epoch_s: f64,
}

/// Scale of the numbers of a variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CfScale {
    pub factor: f64,
    pub offset: f64,
    /// Number that stands for none.
    pub gap: Option<f64>,
    pub time: Option<CfTime>,
}

impl CfScale {
    /// Returns the number that is meant; times as seconds since 1970.
    pub(crate) fn scaled_value(&self, stored: f64) -> f64 {
        if self.gap == Some(stored) {
            return f64::NAN;
        }
        let value = stored * self.factor + self.offset;
        self.time.map_or(value, |time| time.epoch_s + value * time.unit_s)
    }
}

/// Returns the time of a unit such as `seconds since 2024-05-01 12:00:00`; `None` for another
/// unit.
pub(crate) fn cf_time(unit: &str) -> Option<CfTime> {
    let (unit, epoch) = unit.split_once(" since ")?;
    let unit_s = match unit.trim().trim_end_matches('s') {
        "second" | "sec" | "" => 1.0,
        "millisecond" | "msec" | "m" => 1e-3,
        "microsecond" => 1e-6,
        "nanosecond" => 1e-9,
        "minute" | "min" => 60.0,
        "hour" | "hr" | "h" => 3600.0,
        "day" | "d" => DAY_S,
        _ => return None,
    };
    let epoch = epoch.trim().trim_end_matches(" UTC").trim();
    let dated = if epoch.contains(':') { epoch.to_owned() } else { format!("{epoch} 00:00:00") };
    let stamp = parse_stamp(&dated, DateOrder::Open)?;
    let StampDate::Known(day) = stamp.date else { return None };
    let epoch_s = day as f64 * DAY_S + stamp.of_day as f64 / SECOND as f64;
    Some(CfTime { unit_s, epoch_s })
}

/// Returns the unit in the spelling of other files.
pub(crate) fn plain_cf_unit(unit: &str) -> String {
    let same = |spelling: &str| spelling.eq_ignore_ascii_case(unit.trim());
    let known = SPELLINGS.iter().find(|(spelling, _)| same(spelling));
    known.map_or(unit.trim(), |(_, unit)| unit).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_since_an_epoch_become_seconds_since_1970() {
        let time = cf_time("days since 1970-01-02");
        assert_eq!(time, Some(CfTime { unit_s: 86_400.0, epoch_s: 86_400.0 }));
        let time = cf_time("seconds since 1970-01-01T00:01:00Z");
        assert_eq!(time.map(|time| time.epoch_s), Some(60.0));
        assert_eq!(cf_time("m s-1"), None);
        let scale = CfScale { factor: 0.1, offset: 1.0, gap: Some(-9.0), time: None };
        assert!(scale.scaled_value(-9.0).is_nan() && (scale.scaled_value(5.0) - 1.5).abs() < 1e-12);
    }
}
