//! Conversion of the signs of a file to the canonical ones, done here only.

use std::f64::consts::{PI, TAU};

use sistership_model::manifest::{RudderSign, WindDirection};
use sistership_model::trial::{Channel, Trial};

use crate::declarations::North;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::pairs::pair_means;
use crate::recording::Recording;
use crate::table::{ColumnTarget, Table};

/// Converts a table to a recording, with rudder sign, wind direction and continuous heading.
pub(crate) fn convert_table(
    name: &str,
    table: Table,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Recording {
    let trial = Trial {
        name: name.to_owned(),
        manoeuvre: mapping.manoeuvre.clone(),
        depth_m: mapping.depth_m,
        ..Trial::default()
    };
    let mut recording = Recording {
        trial,
        rows: table.rows,
        start: table.start,
        resumed: table.resumed,
        is_stretch: mapping.stretch.is_some(),
        ..Recording::default()
    };
    for (column, mut values) in table.columns.into_iter().zip(table.values) {
        match column.target {
            ColumnTarget::Time => {
                recording.trial.t_s = values;
                recording.time = column.header;
            }
            ColumnTarget::Channel(channel) => {
                recording.columns.insert(channel, column);
                apply_sign(channel, &mut values, mapping, &recording, findings);
                recording.trial.channels.insert(channel, values);
            }
            ColumnTarget::Raw(raw) => {
                recording.raw.insert(raw, values);
            }
            ColumnTarget::Unidentified(_) => {}
        }
    }
    let means = pair_means(&mut recording, findings);
    recording.trial.channels.extend(means);
    if let Some(n_rps) = mapping.n_rps {
        hold_revolutions(&mut recording.trial, n_rps, findings);
    }
    recording
}

/// Adds the revolutions that a trial held; an error if they were recorded.
fn hold_revolutions(trial: &mut Trial, n_rps: f64, findings: &mut Findings) {
    if Channel::SHAFTS.iter().any(|&shaft| trial.channel(shaft).is_some()) {
        let message = "`n_rps` is given, but the file records revolutions; remove one of the two";
        return findings.error(None, None, message);
    }
    trial.channels.insert(Channel::N, vec![n_rps; trial.t_s.len()]);
    let message = format!("revolutions are taken as {n_rps} 1/s throughout: `n_rps` of the trial");
    findings.warning(None, None, message);
}

fn apply_sign(
    channel: Channel,
    values: &mut [f64],
    mapping: &Mapping,
    recording: &Recording,
    findings: &mut Findings,
) {
    let (conventions, declared) = (&mapping.conventions, &mapping.declared);
    match channel {
        Channel::Delta | Channel::DeltaS | Channel::DeltaP
            if conventions.rudder_positive == RudderSign::PortTurn =>
        {
            values.iter_mut().for_each(|value| *value = -*value);
        }
        Channel::Psi => {
            // The unit is checked before unwrapping, which would hide the jump of a heading in
            // degrees.
            check_heading_unit(values, recording, findings);
            if let (North::Magnetic, Some(variation)) = (declared.heading, declared.variation_deg) {
                values.iter_mut().for_each(|value| *value += variation.to_radians());
            }
            unwrap_heading(values);
        }
        Channel::WindFrom | Channel::ApparentWindFrom => {
            check_wind_unit(channel, values, recording, findings);
            let turn = if conventions.wind.direction == WindDirection::To { PI } else { 0.0 };
            values.iter_mut().for_each(|value| *value = wrap_positive(*value + turn));
        }
        _ => {}
    }
}

/// Removes jumps of more than half a turn. The first value and a heading that is already continuous
/// stay as they are.
fn unwrap_heading(values: &mut [f64]) {
    let mut turns = 0.0;
    let mut before = values.first().copied().unwrap_or(0.0);
    for value in values {
        let step = *value - before;
        before = *value;
        if step.abs() > PI {
            turns -= (step / TAU).round();
        }
        *value += turns * TAU;
    }
}

/// Wraps an angle into [0, 2 pi).
fn wrap_positive(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    // A tiny negative angle rounds up to a full turn.
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// Reports a heading that jumps by about 360 "rad" between two samples: a compass in degrees that
/// passes north.
fn check_heading_unit(values: &[f64], recording: &Recording, findings: &mut Findings) {
    let jump =
        (1..values.len()).find(|&k| (300.0..=361.0).contains(&(values[k] - values[k - 1]).abs()));
    if let Some(k) = jump {
        let (header, unit) =
            (recording.column_header(Channel::Psi), recording.declared_unit(Channel::Psi));
        let message = format!(
            "the heading jumps from {:.1} to {:.1} like a compass in degrees, but its unit is \
             `{unit}`; declare `deg`",
            values[k - 1],
            values[k]
        );
        findings.error(Some(recording.row_number(k)), Some(header), message);
    }
}

/// Reports a wind direction of more than two turns, which must be in degrees.
fn check_wind_unit(
    channel: Channel,
    values: &[f64],
    recording: &Recording,
    findings: &mut Findings,
) {
    if let Some(k) = values.iter().position(|value| value.abs() > 2.0 * TAU) {
        let message = format!(
            "{:.1} rad is more than two full circles; the values are probably degrees: declare \
             `deg`",
            values[k]
        );
        findings.error(
            Some(recording.row_number(k)),
            Some(recording.column_header(channel)),
            message,
        );
    }
}

#[cfg(test)]
mod tests {
    use sistership_model::manifest::TrialConventions;

    use super::*;
    use crate::testing::{finding_messages, test_table};

    fn run(
        channel: Channel,
        values: &[f64],
        change: impl Fn(&mut TrialConventions),
    ) -> (Vec<f64>, String) {
        let mut mapping = Mapping::with_canonical_names();
        change(&mut mapping.conventions);
        let mut findings = Findings::default();
        let recording =
            convert_table("a", test_table(&[(channel, values.to_vec())]), &mapping, &mut findings);
        (recording.trial.channels[&channel].clone(), finding_messages(findings))
    }

    #[test]
    fn port_turn_flips_the_rudder_only() {
        let port =
            |conventions: &mut TrialConventions| conventions.rudder_positive = RudderSign::PortTurn;
        assert_eq!(run(Channel::Delta, &[0.1, -0.2], port).0, [-0.1, 0.2]);
        assert_eq!(run(Channel::R, &[0.1, -0.2], port).0, [0.1, -0.2]);
    }

    #[test]
    fn wind_comes_from_where_it_does_not_go_to() {
        let to =
            |conventions: &mut TrialConventions| conventions.wind.direction = WindDirection::To;
        let (from, _) = run(Channel::WindFrom, &[0.0, PI], to);
        assert!((from[0] - PI).abs() < 1e-12 && from[1] < 1e-12);
        assert_eq!(run(Channel::WindFrom, &[-1e-20, 0.1 - TAU], |_| ()).0[0], 0.0);
        assert!(run(Channel::WindFrom, &[10.0, 200.0], |_| ()).1.contains("declare `deg`"));
    }

    #[test]
    fn the_heading_becomes_continuous() {
        let (psi, text) = run(Channel::Psi, &[3.0, -3.1, -2.9, 3.1, 3.0], |_| ());
        assert!(psi.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.0), "{psi:?}");
        assert!((psi[1] - (TAU - 3.1)).abs() < 1e-12 && psi[4] == 3.0);
        assert!(text.is_empty());
        assert!(run(Channel::Psi, &[358.0, 359.5, 1.0], |_| ()).1.contains("declare `deg`"));
    }

    #[test]
    fn a_magnetic_heading_is_corrected_by_the_variation() {
        let mut mapping = Mapping::with_canonical_names();
        mapping.declared.heading = North::Magnetic;
        mapping.declared.variation_deg = Some(-2.0);
        let psi = test_table(&[(Channel::Psi, vec![0.5; 3])]);
        let recording = convert_table("a", psi, &mapping, &mut Findings::default());
        assert!((recording.trial.channels[&Channel::Psi][0] - 0.5 + PI / 90.0).abs() < 1e-12);
    }
}
