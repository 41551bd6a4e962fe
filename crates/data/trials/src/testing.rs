//! Small recordings for tests of the checks.

use std::f64::consts::PI;

use sistership_model::trial::Channel;

use crate::convert::convert_table;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::recording::Recording;
use crate::table::{ColumnTarget, Table, TableColumn};
use crate::units::UnitKind;

/// Returns a table at 2 Hz with canonical names and units.
pub(crate) fn test_table(channels: &[(Channel, Vec<f64>)]) -> Table {
    let rows = channels.first().map_or(0, |(_, values)| values.len());
    let mut table = Table { rows: (2..).take(rows).collect(), ..Table::default() };
    table.columns.push(test_column(0, ColumnTarget::Time, "t_s"));
    table.values.push((0..rows).map(|k| k as f64 * 0.5).collect());
    for (channel, values) in channels {
        table.columns.push(test_column(
            table.columns.len(),
            ColumnTarget::Channel(*channel),
            channel.column_name(),
        ));
        table.values.push(values.clone());
    }
    table
}

fn test_column(index: usize, target: ColumnTarget, header: &str) -> TableColumn {
    TableColumn {
        index,
        header: header.into(),
        target,
        unit: UnitKind::from_target(target).canonical_unit().into(),
        to_si: 1.0,
        at_rest: 0.0,
    }
}

/// Returns a recording at 2 Hz with canonical names and units.
pub(crate) fn test_recording(channels: &[(Channel, Vec<f64>)]) -> Recording {
    let mut recording = convert_table(
        "a.csv",
        test_table(channels),
        &Mapping::with_canonical_names(),
        &mut Findings::default(),
    );
    recording.settle_time();
    recording
}

/// Returns the findings of a check, one per line, errors first.
pub(crate) fn check_messages(
    recording: &Recording,
    check: impl Fn(&Recording, &mut Findings),
) -> String {
    let mut findings = Findings::default();
    check(recording, &mut findings);
    finding_messages(findings)
}

pub(crate) fn finding_messages(findings: Findings) -> String {
    let (errors, warnings) = findings.into_lists();
    let line = |kind: &str, finding: &sistership_model::trial::Finding| {
        format!("{kind} {:?} {:?} {}", finding.row, finding.column, finding.message)
    };
    let errors = errors.iter().map(|finding| line("error", finding));
    errors
        .chain(warnings.iter().map(|finding| line("warning", finding)))
        .collect::<Vec<_>>()
        .join("\n")
}

/// Returns a zigzag of a Nomoto ship (K = 0.1 1/s, T = 10 s) at 5 m/s for 300 s: x, y, psi, u, v,
/// r, delta.
pub(crate) fn zigzag_channels() -> Vec<(Channel, Vec<f64>)> {
    let (mut x, mut y, mut psi, mut r, mut delta) = (0.0, 0.0, 0.0_f64, 0.0, 20.0 * PI / 180.0);
    let names =
        [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V, Channel::R, Channel::Delta];
    let mut channels: Vec<(Channel, Vec<f64>)> =
        names.into_iter().map(|channel| (channel, Vec::new())).collect();
    for _ in 0..600 {
        let (u, v) = (5.0, -15.0 * r);
        let sample = [x, y, psi, u, v, r, delta];
        channels.iter_mut().zip(sample).for_each(|((_, values), value)| values.push(value));
        // Euler steps of 0.05 s, ten for each sample.
        for _ in 0..10 {
            x += 0.05 * (u * psi.cos() - v * psi.sin());
            y += 0.05 * (u * psi.sin() + v * psi.cos());
            psi += 0.05 * r;
            r += 0.05 * (0.1 * delta - r) / 10.0;
        }
        if psi * delta > 0.0 && psi.abs() > 20.0 * PI / 180.0 {
            delta = -delta;
        }
    }
    channels
}

/// Returns the zigzag with one channel changed.
pub(crate) fn zigzag_with(channel: Channel, change: impl Fn(f64) -> f64) -> Recording {
    let mut channels = zigzag_channels();
    for (name, values) in &mut channels {
        if *name == channel {
            values.iter_mut().for_each(|value| *value = change(*value));
        }
    }
    test_recording(&channels)
}
