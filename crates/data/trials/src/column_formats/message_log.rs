//! Messages of several sources, each with its own times, as columns on one clock.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io;

use crate::column_source::MemoryColumns;
use crate::limits::FileLimits;

/// Rate, Hz, up to which the most frequent source gives the common times; a faster one is read at
/// the times of others.
const FASTEST: f64 = 20.0;
/// Multiple of the median step of a source beyond which there is no interpolation between two of its
/// messages.
const BRIDGED: f64 = 2.5;
/// Part of a period by which a direction jumps where it wraps.
const JUMP: f64 = 0.7;

/// Value of a message: name of its column, unit, number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MessageValue {
    pub name: String,
    pub unit: &'static str,
    pub number: f64,
}

/// Readings of one quantity from one source, in the order of time.
#[derive(Debug, Default)]
struct ValueSeries {
    unit: &'static str,
    t: Vec<f64>,
    numbers: Vec<f64>,
}

/// Range in which directions are recorded.
#[derive(Debug, Clone, Copy)]
struct DirectionWrap {
    /// Full circle in the unit of the column.
    period: f64,
    /// True for directions from minus to plus half a circle.
    is_signed: bool,
}

/// Log of messages.
#[derive(Debug)]
pub(crate) struct MessageLog {
    /// By column and source.
    series: BTreeMap<(String, u32), ValueSeries>,
    /// Numbers that may still be taken.
    left: usize,
}

impl MessageLog {
    pub(crate) fn new(limits: FileLimits) -> Self {
        // A number is in memory with its time, and again on the common clock.
        Self { series: BTreeMap::new(), left: limits.unpacked_bytes / 32 }
    }

    /// Adds a reading of a source at a time, s.
    ///
    /// # Errors
    /// Returns an error once the log holds more than the limits allow.
    pub(crate) fn add_value(&mut self, t: f64, source: u32, value: MessageValue) -> io::Result<()> {
        if self.left == 0 {
            return Err(io::Error::other("it holds more numbers than are read; split it"));
        }
        let series = self.series.entry((value.name, source)).or_default();
        // A series must increase strictly in time for the interpolation that follows.
        let is_next = series.t.last().is_none_or(|&last| last < t);
        if t.is_finite() && value.number.is_finite() && is_next {
            self.left -= 1;
            series.unit = value.unit;
            series.t.push(t);
            series.numbers.push(value.number);
        }
        Ok(())
    }

    /// Returns true if a column has readings.
    pub(crate) fn has_column(&self, name: &str) -> bool {
        self.series.keys().any(|(known, _)| known == name)
    }

    /// Gives the readings of a column another name.
    pub(crate) fn rename_column(&mut self, name: &str, to: &str) {
        let all = std::mem::take(&mut self.series).into_iter();
        let renamed = all.map(|((known, source), series)| {
            let name = if known == name { to.to_owned() } else { known };
            ((name, source), series)
        });
        self.series = renamed.collect();
    }

    /// Returns the columns on one clock, seconds since 1970 where `is_dated`.
    ///
    /// # Errors
    /// Returns an error if nothing was read.
    pub(crate) fn into_columns(self, is_dated: bool) -> io::Result<MemoryColumns> {
        let mut chosen = self.select_series();
        let nothing = || io::Error::other("no message of it holds anything that a trial can use");
        let times = shared_times(&chosen).ok_or_else(nothing)?;
        let mut columns = MemoryColumns::default();
        let (name, unit) = if is_dated { ("time", "unix") } else { ("t_s", "s") };
        columns.push_column(name.into(), unit, times.clone());
        for (name, series) in std::mem::take(&mut chosen) {
            columns.push_column(name, series.unit, series.resample_at(&times));
        }
        Ok(columns)
    }

    /// Selects the source with most readings for each column.
    fn select_series(self) -> BTreeMap<String, ValueSeries> {
        let mut chosen: BTreeMap<String, ValueSeries> = BTreeMap::new();
        for ((name, _), series) in self.series {
            let most = chosen.get(&name).map_or(1, |other| other.t.len());
            if series.t.len() > most {
                chosen.insert(name, series);
            }
        }
        chosen
    }
}

/// Returns the times of the most frequent series of at most 20 Hz, or else of the slowest.
fn common_times(series: &BTreeMap<String, ValueSeries>) -> Option<Vec<f64>> {
    let slow = |one: &&ValueSeries| one.median_step() >= 1.0 / FASTEST;
    let frequent = series.values().filter(slow).max_by_key(|one| one.t.len());
    let base = frequent.or_else(|| series.values().min_by_key(|one| one.t.len()))?;
    Some(base.t.clone())
}

/// Returns the common times that all series share, except for those of less than half of the log.
fn shared_times(series: &BTreeMap<String, ValueSeries>) -> Option<Vec<f64>> {
    let times = common_times(series)?;
    let ends = |t: &[f64]| Some((*t.first()?, *t.last()?));
    let (mut from, mut to) = ends(&times)?;
    let half = 0.5 * (to - from);
    for (first, last) in series.values().filter_map(|one| ends(&one.t)) {
        if last - first >= half {
            (from, to) = (from.max(first), to.min(last));
        }
    }
    Some(times.into_iter().filter(|t| (from..=to).contains(t)).collect())
}

impl ValueSeries {
    fn median_step(&self) -> f64 {
        let mut steps: Vec<f64> = self.t.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        if steps.is_empty() {
            return f64::INFINITY;
        }
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Returns the wrap of the numbers, if they are directions that jump where they wrap.
    fn direction_wrap(&self) -> Option<DirectionWrap> {
        let most =
            self.numbers.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        let period = match self.unit {
            "deg" => 360.0,
            "rad" => TAU,
            _ => return None,
        };
        let is_signed = self.numbers.iter().any(|&number| number < 0.0);
        let wraps = most > JUMP * period && most < 1.01 * period;
        wraps.then_some(DirectionWrap { period, is_signed })
    }

    /// Interpolates between the readings before and after each time; NaN in a gap.
    fn resample_at(&self, times: &[f64]) -> Vec<f64> {
        let (longest, wrap) = (BRIDGED * self.median_step(), self.direction_wrap());
        let value = |&time: &f64| {
            let after = self.t.partition_point(|&other| other < time);
            match (after.checked_sub(1), self.t.get(after)) {
                (_, Some(&exact)) if exact == time => self.numbers[after],
                (Some(before), Some(&next)) if next - self.t[before] <= longest => {
                    let share = (time - self.t[before]) / (next - self.t[before]);
                    self.interpolate_between(before, share, wrap)
                }
                _ => f64::NAN,
            }
        };
        times.iter().map(value).collect()
    }

    /// Returns the number at a share of the way from one reading to the next, a direction along the
    /// shorter way.
    fn interpolate_between(&self, before: usize, share: f64, wrap: Option<DirectionWrap>) -> f64 {
        let (from, to) = (self.numbers[before], self.numbers[before + 1]);
        let Some(DirectionWrap { period, is_signed }) = wrap else {
            return from + share * (to - from);
        };
        let change = to - from;
        let found = from + share * (change - (change / period).round() * period);
        if is_signed { found - (found / period).round() * period } else { found.rem_euclid(period) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::column_source::ColumnSource;

    fn value(name: &str, unit: &'static str, number: f64) -> MessageValue {
        MessageValue { name: name.into(), unit, number }
    }

    #[test]
    fn sources_are_put_on_the_clock_of_the_most_frequent_slow_one() {
        let mut log = MessageLog::new(FileLimits::default());
        for k in 0..100 {
            let t = f64::from(k) * 0.1;
            log.add_value(t, 0, value("psi_deg", "deg", (355.0 + 5.0 * t).rem_euclid(360.0)))
                .unwrap();
            log.add_value(t + 0.05, 0, value("n_rpm", "rpm", t)).unwrap();
            log.add_value(t, 7, value("n_rpm", "rpm", 5.0)).unwrap();
        }
        for k in 0..3000 {
            log.add_value(f64::from(k) * 0.003, 0, value("r_rad_s", "rad/s", 0.1)).unwrap();
        }
        let mut columns = log.into_columns(false).unwrap();
        let names: Vec<&str> = columns.columns().iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["t_s", "n_rpm", "psi_deg", "r_rad_s"]);
        let read = columns.read_numbers(&[0, 2]).unwrap();
        assert!((80..=100).contains(&read[0].len()), "{}", read[0].len());
        assert!(read[1].iter().all(|psi| (0.0..360.0).contains(psi) && (psi - 180.0).abs() > 90.0));
    }

    #[test]
    fn a_log_with_too_many_numbers_is_refused() {
        let limits = FileLimits { unpacked_bytes: 320, ..FileLimits::default() };
        let mut log = MessageLog::new(limits);
        let added = (0..11).try_for_each(|k| log.add_value(f64::from(k), 0, value("a", "", 1.0)));
        assert!(added.unwrap_err().to_string().contains("more numbers"));
    }
}
