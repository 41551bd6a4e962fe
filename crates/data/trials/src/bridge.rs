//! Interpolation of short gaps of a channel: along a straight line, or along the integral of its rate
//! where that is recorded. Rows in longer gaps are excluded.

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::kinematics::{column_rate, kinematic_order};
use crate::series::{drop_incomplete_rows, is_angle, shorter_way};
use crate::table::{ColumnTarget, Table};

/// Default longest gap that is filled, s. A straight line over T seconds misses a motion of period
/// P by at most its amplitude times (pi T / P)^2 / 8: with 4 s a tenth of a yawing motion of 14 s,
/// and the roll of small craft altogether, for which a shorter gap is to be declared.
pub(crate) const BRIDGED_S: f64 = 4.0;
/// Multiple of the longest gap, and of the number of its samples, that is filled along the integral of
/// a rate: only the difference of both ends from the integral is a straight line.
const RATED: usize = 5;
/// Largest number of samples that are filled along a straight line, so that a fast recording does not lose seconds
/// unnoticed.
const BRIDGED: usize = 40;

/// Fills short gaps, excludes the rows of long ones, and reports the number of each.
pub(crate) fn bridge_gaps(table: &mut Table, limit_s: f64, findings: &mut Findings) {
    let time = table.columns.iter().position(|column| column.target == ColumnTarget::Time);
    let Some(t) = time.map(|at| table.values[at].clone()) else { return };
    let each = table.columns.iter().map(|column| column.target).enumerate();
    let mut columns: Vec<(usize, ColumnTarget)> =
        each.filter(|(_, target)| *target != ColumnTarget::Time).collect();
    // Rates have to be known across the gaps of the others.
    columns.sort_by_key(|(_, target)| kinematic_order(*target));
    for (at, target) in columns {
        let rate = column_rate(table, target);
        let gaps = GapFilling {
            t_s: &t,
            rate: rate.as_deref(),
            is_angle: is_angle(target),
            longest_s: limit_s,
            fastest: max_rate(target),
        };
        let filled = gaps.fill(&mut table.values[at]);
        filled.report(&table.columns[at].header, limit_s, rate.is_some(), findings);
    }
    drop_incomplete_rows(table);
}

/// Numbers of filled gaps, and of rows in gaps that stay open.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct FilledGaps {
    filled: usize,
    open_rows: usize,
}

impl FilledGaps {
    fn report(self, header: &str, limit_s: f64, is_rated: bool, findings: &mut Findings) {
        let Self { filled, open_rows } = self;
        if filled > 0 {
            let (limit_s, how) = match is_rated {
                true => (limit_s * RATED as f64, "along the integral of its rate"),
                false => (limit_s, "by linear interpolation"),
            };
            let message =
                format!("{filled} gaps of at most {limit_s} s are filled {how} (`bridge_s`)");
            findings.warning(None, Some(header), message);
        }
        if open_rows > 0 {
            let message = format!("{open_rows} rows are in longer gaps and are skipped");
            findings.warning(None, Some(header), message);
        }
    }
}

/// Filling of the gaps of a channel, and its limits.
#[derive(Debug, Clone, Copy)]
struct GapFilling<'a> {
    t_s: &'a [f64],
    /// Rate of the channel by other channels.
    rate: Option<&'a [f64]>,
    is_angle: bool,
    longest_s: f64,
    /// Largest rate of change across a gap, above which it is a jump.
    fastest: f64,
}

/// m/s; a position that moves faster across a gap has jumped.
const FASTEST: f64 = 40.0;

fn max_rate(target: ColumnTarget) -> f64 {
    match target {
        ColumnTarget::Channel(Channel::X | Channel::Y) => FASTEST,
        _ => f64::INFINITY,
    }
}

impl GapFilling<'_> {
    fn fill(&self, values: &mut [f64]) -> FilledGaps {
        let (mut gaps, mut k) = (FilledGaps::default(), 0);
        while k < values.len() {
            if values[k].is_finite() {
                k += 1;
                continue;
            }
            let end = (k..values.len()).find(|&at| values[at].is_finite()).unwrap_or(values.len());
            // A gap at either end of the channel has no value on one side, and stays open.
            match k > 0 && end < values.len() && self.fill_gap(values, k - 1, end) {
                true => gaps.filled += 1,
                false => gaps.open_rows += end - k,
            }
            k = end;
        }
        gaps
    }

    /// Fills the gap between two samples; returns false if it is too long, or a jump.
    fn fill_gap(&self, values: &mut [f64], last: usize, end: usize) -> bool {
        let factor = if self.rate.is_some() { RATED } else { 1 };
        let duration_s = self.t_s[end] - self.t_s[last];
        let is_short = duration_s > 0.0 && duration_s <= factor as f64 * self.longest_s;
        if !is_short || end - last > factor * BRIDGED + 1 {
            return false;
        }
        // Change along the integral of the rate, and the rest along a straight line. Interpolation
        // of a wrapped direction must not pass through the other half of the circle.
        let along = self.integrals(last, end);
        let rest = values[end] - values[last] - along[end - last];
        let rest = if self.is_angle { shorter_way(rest) } else { rest };
        // False as well where the rate is not known throughout.
        let is_near = rest.abs() <= self.fastest * duration_s;
        if !is_near {
            return false;
        }
        for at in last + 1..end {
            let share = (self.t_s[at] - self.t_s[last]) / duration_s;
            values[at] = values[last] + along[at - last] + share * rest;
        }
        true
    }

    /// Returns the integrals of the rate from a sample on; zeros without a rate.
    fn integrals(&self, last: usize, end: usize) -> Vec<f64> {
        let mut sum = 0.0;
        let step = |at: usize| {
            if let (Some(rate), true) = (self.rate, at > last) {
                sum += 0.5 * (rate[at - 1] + rate[at]) * (self.t_s[at] - self.t_s[at - 1]);
            }
            sum
        };
        (last..=end).map(step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_table};

    #[test]
    fn positions_are_filled_along_their_velocities() {
        // A quarter circle of 100 m at 5 m/s; 8 s of its positions are lost.
        let angle = |k: usize| 0.05 * 0.5 * k as f64;
        let lost = |k: usize, value: f64| if (20..36).contains(&k) { f64::NAN } else { value };
        let channel = |value: &dyn Fn(usize) -> f64| (0..60).map(value).collect::<Vec<f64>>();
        let mut one = test_table(&[
            (Channel::X, channel(&|k| lost(k, 100.0 * angle(k).sin()))),
            (Channel::Y, channel(&|k| lost(k, 100.0 * (1.0 - angle(k).cos())))),
            (Channel::Psi, channel(&angle)),
            (Channel::U, vec![5.0; 60]),
            (Channel::V, vec![0.0; 60]),
        ]);
        bridge_gaps(&mut one, 4.0, &mut Findings::default());
        assert_eq!(one.rows.len(), 60);
        for k in 20..36 {
            assert!((one.values[1][k] - 100.0 * angle(k).sin()).abs() < 0.01);
        }
    }

    #[test]
    fn short_gaps_are_filled_and_long_ones_left_out() {
        let mut psi = vec![6.2, f64::NAN, 0.1, 0.2, 0.3];
        psi.extend([f64::NAN; 12]);
        psi.extend([0.4, 0.5]);
        let mut one = test_table(&[(Channel::Psi, psi)]);
        let before = one.rows.len();
        let mut findings = Findings::default();
        bridge_gaps(&mut one, 4.0, &mut findings);
        assert_eq!(before - one.rows.len(), 12);
        let filled = one.values.iter().map(|values| values[1]).fold(0.0, f64::max);
        assert!((filled - 6.2 - 0.5 * (std::f64::consts::TAU - 6.1)).abs() < 1e-12, "{filled}");
        let text = finding_messages(findings);
        assert!(
            text.contains("1 gaps of at most 4 s") && text.contains("12 rows are in longer gaps"),
            "{text}"
        );
    }
}
