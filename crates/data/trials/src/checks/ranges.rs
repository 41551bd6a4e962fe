//! Check for values that neither ships nor model basins produce, with their most likely cause.

use std::f64::consts::{FRAC_PI_2, PI};

use sistership_model::trial::Channel;

use crate::findings::{Findings, Severity};
use crate::recording::Recording;
use crate::stats::nearest_quantile;

/// Channel, largest magnitude, and advice where it is exceeded.
///
/// The limits hold for a one-metre model as for a tanker: 40 m/s is beyond any displacement ship,
/// 1.5 rad/s (86 deg/s) beyond a free-running model at full rudder, 200 turns per second beyond a
/// model's propeller.
const LIMITS: [(Channel, f64, &str); 11] = [
    (Channel::U, 40.0, "too fast for a ship; check the column and its unit"),
    (Channel::V, 40.0, "too fast for a ship; check the column and its unit"),
    (Channel::UWater, 40.0, "too fast for a ship; check the column and its unit"),
    (Channel::VWater, 40.0, "too fast for a ship; check the column and its unit"),
    (
        Channel::R,
        1.5,
        "too large a yaw rate for a ship; if the values are degrees per second declare `deg/s`",
    ),
    (
        Channel::P,
        3.0,
        "too large a roll rate for a ship; if the values are degrees per second declare `deg/s`",
    ),
    (Channel::Phi, FRAC_PI_2, "too large a roll angle; if the values are degrees declare `deg`"),
    (
        Channel::Delta,
        FRAC_PI_2,
        "too large a rudder angle; if the values are degrees declare `deg`",
    ),
    (
        Channel::N,
        200.0,
        "too high for propeller revolutions per second; if the values are per \
                         minute declare `rpm`",
    ),
    (Channel::WindSpeed, 100.0, "too fast for a wind; check the column and its unit"),
    (Channel::ApparentWindSpeed, 100.0, "too fast for a wind; check the column and its unit"),
];

pub(crate) fn check_ranges(recording: &Recording, findings: &mut Findings) {
    for (channel, limit, advice) in LIMITS {
        report_beyond(recording, channel, |value| value.abs() > limit, advice, findings);
    }
    for channel in [Channel::WindSpeed, Channel::ApparentWindSpeed] {
        report_beyond(
            recording,
            channel,
            |value| value < 0.0,
            "a wind speed cannot be negative; give the direction in its own column",
            findings,
        );
    }
    report_beyond(
        recording,
        Channel::Depth,
        |value| value <= 0.0,
        "depth is positive downwards",
        findings,
    );
    tiny_rudder(recording, findings);
    fast_propeller(recording, findings);
    idle_propeller(recording, findings);
}

fn report_beyond(
    recording: &Recording,
    channel: Channel,
    wrong: impl Fn(f64) -> bool,
    advice: &str,
    findings: &mut Findings,
) {
    let Some(values) = recording.channel(channel) else { return };
    let hits = recording.find_samples(0..values.len(), |k| wrong(values[k]));
    let unit = recording.canonical_unit(channel);
    // The value is in canonical units: name the declared one if it differs.
    let note = conversion_note(recording, channel, unit);
    findings.report_rows(Severity::Error, recording.column_header(channel), &hits, |k| {
        format!("{:.4} {unit}{note}: {advice}", values[k])
    });
}

fn conversion_note(recording: &Recording, channel: Channel, canonical: &str) -> String {
    let declared = recording.declared_unit(channel);
    let same = declared.is_empty() || declared == canonical;
    if same { String::new() } else { format!(" (converted from {declared})") }
}

/// Warns of a rudder that never exceeds a degree: it is probably recorded in radians.
fn tiny_rudder(recording: &Recording, findings: &mut Findings) {
    let Some(values) = recording
        .channel(Channel::Delta)
        .filter(|_| recording.declared_unit(Channel::Delta) == "deg")
    else {
        return;
    };
    let most = values.iter().fold(0.0_f64, |most, value| most.max(value.abs())) * 180.0 / PI;
    // A rudder below 0.03 deg is amidships throughout.
    if (0.03..1.0).contains(&most) {
        let message = format!(
            "the largest rudder angle is {most:.2} deg; if the values are radians declare \
                     `rad`"
        );
        findings.warning(None, Some(recording.column_header(Channel::Delta)), message);
    }
}

fn fast_propeller(recording: &Recording, findings: &mut Findings) {
    let Some(values) = recording.channel(Channel::N) else { return };
    // The median, as single values may be faults.
    let typical = nearest_quantile(values.iter().map(|value| value.abs()), 0.5);
    if typical > 40.0 {
        let message = format!(
            "the propeller revolutions are typically {typical:.0} per second; if the values are \
             per minute declare `rpm`"
        );
        findings.warning(None, Some(recording.column_header(Channel::N)), message);
    }
}

/// Warns of revolutions that are zero throughout while the ship keeps its way: a recorder that does
/// not get them often writes zeros. A ship whose propeller is stopped slows down.
fn idle_propeller(recording: &Recording, findings: &mut Findings) {
    let recorded: Vec<_> =
        Channel::SHAFTS.into_iter().filter(|&one| recording.channel(one).is_some()).collect();
    let values = recorded.iter().flat_map(|&shaft| recording.channel(shaft).into_iter().flatten());
    let is_idle = !recorded.is_empty() && values.copied().all(|n| n == 0.0);
    let Some(u) = recording.channel(Channel::U).filter(|u| is_idle && u.len() >= 4) else { return };
    // Single readings may be faults, hence medians of the first and the last quarter.
    let quarter = u.len() / 4;
    let typical = |part: &[f64]| nearest_quantile(part.iter().copied(), 0.5);
    let (first, last) = (typical(&u[..quarter]), typical(&u[u.len() - quarter..]));
    if first > 0.0 && last > 0.5 * first {
        let message = "all revolutions are 0 while the ship keeps its way; if they were not \
                       recorded leave the column out, or state them as `n_rps` of the trial";
        findings.warning(None, Some(recording.column_header(recorded[0])), message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording};

    fn of(channel: Channel, values: &[f64]) -> String {
        check_messages(&test_recording(&[(channel, values.to_vec())]), check_ranges)
    }

    #[test]
    fn degrees_taken_for_radians_are_named() {
        let text = of(Channel::Delta, &[0.0, 35.0, -20.0]);
        assert!(
            text.starts_with(
                "error Some(3) Some(\"delta_rad\") 35.0000 rad: too large a rudder angle"
            ),
            "{text}"
        );
        assert!(text.contains("declare `deg`"));
        assert!(of(Channel::R, &[0.0, 2.5]).contains("declare `deg/s`"));
    }

    #[test]
    fn impossible_values_are_refused() {
        assert!(of(Channel::U, &[41.0]).starts_with("error Some(2)"));
        assert!(of(Channel::WindSpeed, &[-1.0]).contains("cannot be negative"));
        assert!(of(Channel::Depth, &[0.0]).contains("positive"));
        assert!(of(Channel::N, &[80.0, 80.0]).starts_with("warning"));
    }

    #[test]
    fn revolutions_of_a_recorder_that_does_not_get_them_are_remarked() {
        let with = |speeds: [f64; 4], n: f64| {
            let channels = [(Channel::U, speeds.to_vec()), (Channel::N, vec![n; 4])];
            check_messages(&test_recording(&channels), check_ranges)
        };
        assert!(with([5.0, 4.0, 3.5, 4.0], 0.0).contains("all revolutions are 0"));
        // A ship that coasts loses its way.
        assert_eq!(with([5.0, 4.0, 3.0, 2.0], 0.0), "");
        assert_eq!(with([5.0, 4.0, 3.5, 4.0], 2.0), "");
    }

    #[test]
    fn ordinary_values_pass() {
        for (channel, value) in [
            (Channel::U, 15.0),
            (Channel::R, 0.11),
            (Channel::Delta, -0.62),
            (Channel::N, 20.0),
            (Channel::Phi, 0.5),
        ] {
            assert_eq!(of(channel, &[value, 0.5 * value]), "");
        }
    }

    #[test]
    fn radians_taken_for_degrees_are_remarked() {
        let mut recording = test_recording(&[(Channel::Delta, vec![0.0, 0.17 * PI / 180.0])]);
        if let Some(column) = recording.columns.get_mut(&Channel::Delta) {
            column.unit = "deg".into();
        }
        assert!(check_messages(&recording, check_ranges).contains("declare `rad`"));
    }
}
