//! Readings of several sensors, each at its own rate, on one time base.

use std::f64::consts::{PI, TAU};

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::table::{Column, Raw, Table, Target};

/// Readings further apart than so many of a sensor's median steps are not bridged: rows between them are left out.
const BRIDGED: f64 = 2.5;

/// One sensor's readings in canonical units, in order of time.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    pub column: Column,
    pub t: Vec<f64>,
    pub values: Vec<f64>,
}

/// What is told of one series at the times of the base.
struct Sampled {
    values: Vec<f64>,
    /// Rows that lie in a gap.
    lost: usize,
}

/// Adds series to a table at the table's own times; rows where one has no reading nearby are left out.
pub(crate) fn join(table: &mut Table, series: Vec<Series>, findings: &mut Findings) {
    let Some(at) = table.columns.iter().position(|column| column.target == Target::Time) else {
        return;
    };
    for Series { column, t, values } in series {
        if let Some(twice) = table.columns.iter().find(|known| known.target == column.target) {
            let message =
                format!("gives {}, as `{}` does; keep one", column.target.name(), twice.header);
            findings.error(None, Some(&column.header), message);
            continue;
        }
        let sampled = sample(&table.values[at], &t, &values, is_angle(column.target));
        if sampled.lost > 0 {
            let message = format!(
                "has no reading near {} of {} rows, which are left out; nothing is interpolated over a gap",
                sampled.lost,
                table.rows.len()
            );
            findings.warning(None, Some(&column.header), message);
        }
        table.columns.push(column);
        table.values.push(sampled.values);
    }
    leave_out(table);
}

/// Between the readings before and after each time, along the shorter way round for an angle; NaN in a gap.
fn sample(times: &[f64], t: &[f64], values: &[f64], is_angle: bool) -> Sampled {
    let longest = BRIDGED * median_step(t);
    let mut lost = 0;
    let values = times.iter().map(|&time| {
        let after = t.partition_point(|&other| other < time);
        let value = match (after.checked_sub(1), t.get(after)) {
            (_, Some(&exact)) if exact == time => values[after],
            (Some(before), Some(&next)) if next - t[before] <= longest => {
                let share = (time - t[before]) / (next - t[before]);
                let change = values[after] - values[before];
                let turns = if is_angle { ((change + PI) / TAU).floor() * TAU } else { 0.0 };
                values[before] + share * (change - turns)
            }
            _ => f64::NAN,
        };
        lost += usize::from(value.is_nan());
        value
    });
    Sampled { values: values.collect(), lost }
}

fn median_step(t: &[f64]) -> f64 {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

fn is_angle(target: Target) -> bool {
    matches!(
        target,
        Target::Channel(Channel::Psi | Channel::WindFrom | Channel::ApparentWindFrom)
            | Target::Raw(Raw::Course | Raw::Longitude)
    )
}

/// Takes rows with a gap out of every column; those that follow them resume.
fn leave_out(table: &mut Table) {
    let whole: Vec<bool> = (0..table.rows.len())
        .map(|k| table.values.iter().all(|values| values[k].is_finite()))
        .collect();
    let resumes = (1..whole.len()).filter(|&k| whole[k] && !whole[k - 1]).map(|k| table.rows[k]);
    let resumes: Vec<u32> = resumes.collect();
    table.resumed.extend(resumes);
    table.resumed.sort_unstable();
    table.resumed.dedup();
    keep(&mut table.rows, &whole);
    table.values.iter_mut().for_each(|values| keep(values, &whole));
}

fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut flags = kept.iter();
    values.retain(|_| flags.next().copied().unwrap_or(false));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{messages, table};

    fn series(channel: Channel, t: &[f64], values: &[f64]) -> Series {
        let column = Column {
            index: 0,
            header: channel.name().into(),
            target: Target::Channel(channel),
            unit: String::new(),
            to_si: 1.0,
        };
        Series { column, t: t.to_vec(), values: values.to_vec() }
    }

    #[test]
    fn a_slower_sensor_is_read_between_its_readings_and_gaps_stay_gaps() {
        // The base is at 0, 0.5, ... 4.5 s.
        let mut base = table(&[(Channel::U, vec![1.0; 10])]);
        let psi = series(Channel::Psi, &[0.0, 1.0, 3.9, 4.9], &[6.2, 0.1, 0.2, 0.3]);
        let mut findings = Findings::default();
        join(&mut base, vec![psi, series(Channel::U, &[0.0], &[1.0])], &mut findings);
        assert_eq!(base.values[0], [0.0, 0.5, 1.0, 4.0, 4.5]);
        assert!((base.values[2][1] - (6.2 + 0.5 * (TAU + 0.1 - 6.2))).abs() < 1e-12);
        assert_eq!((base.rows[3], base.resumed.as_slice()), (10, &[10][..]));
        let text = messages(findings);
        assert!(text.contains("near 5 of 10 rows") && text.contains("gives u, as"), "{text}");
    }
}
