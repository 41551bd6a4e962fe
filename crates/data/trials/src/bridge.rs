//! Interpolation of short gaps of a channel along a straight line; rows in longer gaps are
//! excluded.

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::series::{drop_incomplete_rows, is_angle, shorter_way};
use crate::table::{ColumnTarget, Table};

/// Default longest gap that is filled, s. A straight line over T seconds misses a motion of period
/// P by at most its amplitude times (pi T / P)^2 / 8: with 4 s a tenth of a yawing motion of 14 s,
/// and the roll of small craft altogether, for which a shorter gap is to be declared.
pub(crate) const BRIDGED_S: f64 = 4.0;
/// Largest number of samples that are filled, so that a fast recording does not lose seconds
/// unnoticed.
const BRIDGED: usize = 40;

/// Fills short gaps, excludes the rows of long ones, and reports the number of each.
pub(crate) fn bridge_gaps(table: &mut Table, limit_s: f64, findings: &mut Findings) {
    let time = table.columns.iter().position(|column| column.target == ColumnTarget::Time);
    let Some(t) = time.map(|at| table.values[at].clone()) else { return };
    for (column, values) in table.columns.iter().zip(&mut table.values) {
        if column.target == ColumnTarget::Time {
            continue;
        }
        let bounds = GapBounds {
            is_angle: is_angle(column.target),
            longest_s: limit_s,
            fastest: max_rate(column.target),
        };
        let (filled, open) = fill_gaps(&t, values, bounds);
        if filled > 0 {
            let message = format!(
                "{filled} gaps of at most {limit_s} s are filled by linear interpolation \
                 (`bridge_s`)"
            );
            findings.warning(None, Some(&column.header), message);
        }
        if open > 0 {
            let message = format!("{open} rows are in longer gaps and are skipped");
            findings.warning(None, Some(&column.header), message);
        }
    }
    drop_incomplete_rows(table);
}

/// Limits of the gaps that are filled.
#[derive(Debug, Clone, Copy)]
struct GapBounds {
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

/// Fills gaps of one channel; returns the number of filled gaps, and of rows in gaps that stay
/// open.
fn fill_gaps(t: &[f64], values: &mut [f64], bounds: GapBounds) -> (usize, usize) {
    let (mut filled, mut open, mut k) = (0, 0, 0);
    while k < values.len() {
        if values[k].is_finite() {
            k += 1;
            continue;
        }
        let end = (k..values.len()).find(|&at| values[at].is_finite()).unwrap_or(values.len());
        // A gap at either end of the channel has no value on one side, and stays open.
        let inside = k > 0 && end < values.len() && end - k <= BRIDGED;
        let last = k.saturating_sub(1);
        let (from, duration) = (values[last], t.get(end).map_or(f64::NAN, |end| end - t[last]));
        let change = values.get(end).map_or(f64::NAN, |end| end - from);
        // Interpolation of a wrapped direction must not pass through the other half of the circle.
        let change = if bounds.is_angle { shorter_way(change) } else { change };
        let is_near = change.abs() <= bounds.fastest * duration;
        if inside && duration > 0.0 && duration <= bounds.longest_s && is_near {
            for at in k..end {
                values[at] = from + change * (t[at] - t[last]) / duration;
            }
            filled += 1;
        } else {
            open += end - k;
        }
        k = end;
    }
    (filled, open)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_table};

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
