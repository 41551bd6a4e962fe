//! Interpolation of the readings of several sensors, each with its own rate, to one time base.

use std::f64::consts::{PI, TAU};

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::table::{ColumnTarget, RawQuantity, Table, TableColumn, TimeOrigin};

/// Multiple of the median step of a sensor beyond which there is no interpolation between two
/// readings: rows between them are excluded.
const BRIDGED: f64 = 2.5;

/// Readings of one sensor in canonical units, in order of time.
#[derive(Debug, Clone)]
pub(crate) struct SensorSeries {
    pub column: TableColumn,
    pub t: Vec<f64>,
    pub values: Vec<f64>,
}

/// Values of a series at the times of the base.
struct ResampledSeries {
    values: Vec<f64>,
    /// Number of rows that are in a gap.
    lost: usize,
}

/// Returns the columns of the file of a sensor as series, with an offset of their times; times that
/// go back are left to the check of time.
pub(crate) fn table_series(table: Table, offset_s: f64) -> Vec<SensorSeries> {
    let is_time = |column: &TableColumn| column.target == ColumnTarget::Time;
    let Some(at) = table.columns.iter().position(is_time) else { return Vec::new() };
    let t: Vec<f64> = table.values[at].iter().map(|t| t + offset_s).collect();
    let others = table.columns.into_iter().zip(table.values).filter(|(column, _)| !is_time(column));
    others.map(|(column, values)| SensorSeries { column, t: t.clone(), values }).collect()
}

/// Returns the offset that is added to the seconds of a sensor to obtain those of the base.
///
/// # Errors
/// Returns an error if only one of the files has calendar times and no offset is declared.
pub(crate) fn offset_s(
    base: Option<&TimeOrigin>,
    sensor: Option<&TimeOrigin>,
    declared: Option<f64>,
) -> Result<f64, String> {
    let starts = match (base, sensor) {
        (Some(base), Some(sensor)) if base.dated && sensor.dated => Some(sensor.at_s - base.at_s),
        (Some(base), Some(sensor)) => {
            // The time of day alone is known of at least one of them: they are assumed to be less
            // than half a day apart.
            Some((sensor.at_s - base.at_s + 43_200.0).rem_euclid(86_400.0) - 43_200.0)
        }
        (None, None) => Some(0.0),
        _ => None,
    };
    match (starts, declared) {
        (Some(starts), declared) => Ok(starts + declared.unwrap_or(0.0)),
        (None, Some(declared)) => Ok(declared),
        (None, None) => {
            Err("only one of the files has calendar times; declare `clock_offset_s`, which is \
                 added to its times to give those of the first file"
                .into())
        }
    }
}

/// Adds series to a table at the times of the table; rows without a nearby reading are excluded.
pub(crate) fn join_series(table: &mut Table, series: Vec<SensorSeries>, findings: &mut Findings) {
    let Some(at) = table.columns.iter().position(|column| column.target == ColumnTarget::Time)
    else {
        return;
    };
    for SensorSeries { column, t, values } in series {
        if let Some(twice) = table.columns.iter().find(|known| known.target == column.target) {
            let message =
                format!("gives {}, as `{}` does; keep one", column.target.name(), twice.header);
            findings.error(None, Some(&column.header), message);
            continue;
        }
        // The binary search of the interpolation needs strictly increasing times.
        if t.windows(2).any(|pair| pair[0] >= pair[1]) {
            let message = "its time does not increase throughout; sort its rows and remove \
                           repeated ones";
            findings.error(None, Some(&column.header), message);
            continue;
        }
        let sampled = resample_series(&table.values[at], &t, &values, is_angle(column.target));
        if sampled.lost > 0 {
            let message = format!(
                "has no reading near {} of {} rows, which are skipped; gaps are not interpolated",
                sampled.lost,
                table.rows.len()
            );
            findings.warning(None, Some(&column.header), message);
        }
        table.columns.push(column);
        table.values.push(sampled.values);
    }
    drop_incomplete_rows(table);
}

/// Interpolates between the readings before and after each time, along the shorter way for an
/// angle; NaN in a gap.
fn resample_series(times: &[f64], t: &[f64], values: &[f64], is_angle: bool) -> ResampledSeries {
    let longest = BRIDGED * median_step(t);
    let mut lost = 0;
    let values = times.iter().map(|&time| {
        let after = t.partition_point(|&other| other < time);
        let value = match (after.checked_sub(1), t.get(after)) {
            // A reading at the time itself is valid even next to a gap.
            (_, Some(&exact)) if exact == time => values[after],
            (Some(before), Some(&next)) if next - t[before] <= longest => {
                let share = (time - t[before]) / (next - t[before]);
                let change = values[after] - values[before];
                let change = if is_angle { shorter_way(change) } else { change };
                values[before] + share * change
            }
            _ => f64::NAN,
        };
        lost += usize::from(value.is_nan());
        value
    });
    ResampledSeries { values: values.collect(), lost }
}

/// Returns a change of direction along the shorter way, in -pi to pi.
pub(crate) fn shorter_way(change: f64) -> f64 {
    change - ((change + PI) / TAU).floor() * TAU
}

fn median_step(t: &[f64]) -> f64 {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

pub(crate) fn is_angle(target: ColumnTarget) -> bool {
    matches!(
        target,
        ColumnTarget::Channel(Channel::Psi | Channel::WindFrom | Channel::ApparentWindFrom)
            | ColumnTarget::Raw(RawQuantity::Course | RawQuantity::Longitude)
    )
}

/// Removes rows with a gap from every column; the rows after them are marked as resumed.
pub(crate) fn drop_incomplete_rows(table: &mut Table) {
    let whole: Vec<bool> = (0..table.rows.len())
        .map(|k| table.values.iter().all(|values| values[k].is_finite()))
        .collect();
    let resumes = (1..whole.len()).filter(|&k| whole[k] && !whole[k - 1]).map(|k| table.rows[k]);
    let resumes: Vec<u32> = resumes.collect();
    table.resumed.extend(resumes);
    table.resumed.sort_unstable();
    table.resumed.dedup();
    retain_flagged(&mut table.rows, &whole);
    table.values.iter_mut().for_each(|values| retain_flagged(values, &whole));
}

fn retain_flagged<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut flags = kept.iter();
    values.retain(|_| flags.next().copied().unwrap_or(false));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_table};

    fn series(channel: Channel, t: &[f64], values: &[f64]) -> SensorSeries {
        let column = TableColumn {
            index: 0,
            header: channel.name().into(),
            target: ColumnTarget::Channel(channel),
            unit: String::new(),
            to_si: 1.0,
            at_rest: 0.0,
        };
        SensorSeries { column, t: t.to_vec(), values: values.to_vec() }
    }

    #[test]
    fn clocks_are_compared_where_both_are_known() {
        let start = |at_s, dated| TimeOrigin { text: String::new(), at_s, dated };
        let (morning, day) = (start(10.0, false), start(19_844.0 * 86_400.0 + 86_399.0, true));
        assert_eq!(offset_s(Some(&morning), Some(&day), None), Ok(-11.0));
        assert_eq!(offset_s(Some(&day), Some(&start(day.at_s + 5.0, true)), Some(0.5)), Ok(5.5));
        assert_eq!(offset_s(None, None, None), Ok(0.0));
        assert_eq!(offset_s(None, Some(&day), Some(-3.0)), Ok(-3.0));
        assert!(offset_s(None, Some(&day), None).is_err());
    }

    #[test]
    fn a_slower_sensor_is_read_between_its_readings_and_gaps_stay_gaps() {
        // The base is at 0, 0.5, ... 4.5 s.
        let mut base = test_table(&[(Channel::U, vec![1.0; 10])]);
        let psi = series(Channel::Psi, &[0.0, 1.0, 3.9, 4.9], &[6.2, 0.1, 0.2, 0.3]);
        let mut findings = Findings::default();
        join_series(&mut base, vec![psi, series(Channel::U, &[0.0], &[1.0])], &mut findings);
        assert_eq!(base.values[0], [0.0, 0.5, 1.0, 4.0, 4.5]);
        assert!((base.values[2][1] - (6.2 + 0.5 * (TAU + 0.1 - 6.2))).abs() < 1e-12);
        assert_eq!((base.rows[3], base.resumed.as_slice()), (10, &[10][..]));
        let text = finding_messages(findings);
        assert!(text.contains("near 5 of 10 rows") && text.contains("gives u, as"), "{text}");
    }
}
