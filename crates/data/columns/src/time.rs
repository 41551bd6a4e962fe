//! The column of time and its unit.

use crate::data::ColumnData;
use crate::own_evidence::OwnEvidence;
use crate::role::{QuantityKind, Role, Unit};

/// Usual interval between samples, s, and the standard deviation of its natural logarithm: from
/// about 100 Hz to one sample a minute lies within two standard deviations.
const INTERVAL_S: f64 = 0.5;
const SCATTER: f64 = 2.1;
/// Log odds below the best within which a unit is considered.
const CONSIDERED: f64 = 12.0;
/// Range of numbers that are read as seconds since 1970: years 2001 to 2065.
const UNIX: std::ops::Range<f64> = 1.0e9..3.0e9;

/// A unit of time and its log odds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeUnit {
    pub name: &'static str,
    pub to_si: f64,
    pub odds: f64,
}

/// Returns the column that most likely is time.
pub(crate) fn time_column(columns: &[ColumnData], own: &[OwnEvidence]) -> Option<usize> {
    let scored = own.iter().zip(columns).enumerate().filter_map(|(at, (own, column))| {
        let written = if column.written_time.is_some() { 8.0 } else { 0.0 };
        let summary = &own.summary;
        let runs = summary.is_clock() || (written > 0.0 && summary.forward > 0.9);
        if !runs {
            return None;
        }
        // Recorders sample at regular intervals, and mostly write time in the first column.
        let regular = 3.0 * summary.regular + 4.0 * summary.steady;
        let counter = if summary.is_counter { -5.0 } else { 0.0 };
        let first = if at == 0 { 1.0 } else { 0.0 };
        // A name of another quantity counts against time, up to a limit.
        let named = own.name_odds(Role::Time) - own.unassigned_odds().min(6.0);
        Some((at, named + written + regular + counter + first))
    });
    scored.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
}

/// Returns the columns without a name that run as regularly as a time column without one: a number
/// of the row, or seconds.
pub(crate) fn rival_clocks(own: &[OwnEvidence], time: usize) -> Vec<usize> {
    let is_steady =
        |own: &OwnEvidence| own.is_open() && own.summary.is_clock() && own.summary.steady > 0.9;
    let others = (0..own.len()).filter(|&at| at != time && is_steady(&own[at]));
    if is_steady(&own[time]) { others.collect() } else { Vec::new() }
}

/// Returns the units in which the column may be, best first, with log odds.
pub(crate) fn candidate_units(column: &ColumnData, own: &OwnEvidence) -> Vec<TimeUnit> {
    let of = |unit: &Unit| {
        let interval_s = own.summary.step * unit.to_si;
        let usual = -0.5 * ((interval_s / INTERVAL_S).ln() / SCATTER).powi(2);
        TimeUnit { name: unit.name, to_si: unit.to_si, odds: usual }
    };
    if let Some(name) = column.written_time {
        return vec![TimeUnit { name, to_si: 1.0, odds: 0.0 }];
    }
    if UNIX.contains(&own.summary.median) {
        return vec![TimeUnit { name: "unix", to_si: 1.0, odds: 0.0 }];
    }
    let all = QuantityKind::Time.known_units();
    if let Some(written) = own.header.unit_of_kind(QuantityKind::Time) {
        let known = all.iter().find(|unit| unit.name == written);
        return known.map(|unit| TimeUnit { odds: 0.0, ..of(unit) }).into_iter().collect();
    }
    // Seconds are usual: another unit has to explain more.
    let mut units: Vec<TimeUnit> = all.iter().map(of).collect();
    units.iter_mut().skip(1).for_each(|unit| unit.odds -= 3.0);
    units.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    let best = units.first().map_or(0.0, |unit| unit.odds);
    units.retain(|unit| unit.odds > best - CONSIDERED);
    units.truncate(3);
    units
}
