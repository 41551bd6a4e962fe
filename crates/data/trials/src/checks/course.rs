//! Check of the unit of a heading against the track, for recordings without a yaw rate.

use std::f64::consts::PI;

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;
use crate::stats::{sample_blocks, value_range};

/// Agreement of heading and course (1: constant difference) below which the declared unit is
/// doubted, and above which degrees are accepted.
const DOUBTED: f64 = 0.5;
const BELIEVED: f64 = 0.9;
/// rad; with less turning, a course agrees with any heading.
const TURNED: f64 = 0.5;
/// rad and rad/s; beyond these a heading without positions to compare with is assumed to be in
/// degrees.
const MANY_TURNS: f64 = 100.0;
const FAST: f64 = 0.2;

pub(crate) fn check_course(recording: &Recording, findings: &mut Findings) {
    let Some(psi) = recording.channel(Channel::Psi) else { return };
    let declared = recording.declared_unit(Channel::Psi);
    if declared != "rad" || recording.channel(Channel::R).is_some() {
        return;
    }
    let doubtful = match (recording.channel(Channel::X), recording.channel(Channel::Y)) {
        (Some(x), Some(y)) => {
            // A constant difference is allowed, so that an offset of the compass does not matter.
            let agreement = |scale: f64| course_agreement(recording, psi, scale, x, y);
            value_range(psi) * PI / 180.0 > TURNED
                && agreement(1.0) < DOUBTED
                && agreement(PI / 180.0) > BELIEVED
        }
        _ => {
            value_range(psi) > MANY_TURNS && value_range(psi) / recording.trial.duration_s() > FAST
        }
    };
    if doubtful {
        let message = "the heading looks like degrees although its unit is `rad`; declare `deg`";
        findings.error(None, Some(recording.column_header(Channel::Psi)), message);
    }
}

/// Returns the length of the mean unit vector of course less scaled heading, weighted by distance.
fn course_agreement(recording: &Recording, psi: &[f64], scale: f64, x: &[f64], y: &[f64]) -> f64 {
    let (mut north, mut east, mut distance) = (0.0, 0.0, 0.0);
    for block in sample_blocks(recording) {
        let (dx, dy) = (block.total_change(x), block.total_change(y));
        // Mean heading of the block: the displacement is rotated into ship-fixed axes.
        let heading = scale * 0.5 * (psi[block.first] + psi[block.last]);
        north += dx * heading.cos() + dy * heading.sin();
        east += dy * heading.cos() - dx * heading.sin();
        distance += dx.hypot(dy);
    }
    if distance > 0.0 { north.hypot(east) / distance } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording, zigzag_channels};

    fn heading_only(scale: f64, keep: &[Channel]) -> String {
        let mut channels = zigzag_channels();
        channels.retain(|(channel, _)| keep.contains(channel));
        channels.iter_mut().filter(|(channel, _)| *channel == Channel::Psi).for_each(
            |(_, values)| {
                values.iter_mut().for_each(|value| *value *= scale);
            },
        );
        check_messages(&test_recording(&channels), check_course)
    }

    #[test]
    fn degrees_show_in_the_track() {
        let keep = [Channel::X, Channel::Y, Channel::Psi];
        assert_eq!(heading_only(1.0, &keep), "");
        assert!(heading_only(180.0 / PI, &keep).contains("declare `deg`"));
    }

    #[test]
    fn degrees_show_in_many_turns() {
        let turning: Vec<f64> = (0..600).map(|k| 0.5 * k as f64).collect();
        assert!(
            check_messages(&test_recording(&[(Channel::Psi, turning)]), check_course)
                .contains("declare `deg`")
        );
        assert_eq!(heading_only(1.0, &[Channel::Psi]), "");
    }
}
