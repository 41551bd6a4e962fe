//! Check of the heading against the yaw rate.

use std::f64::consts::PI;

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;
use crate::stats::{ProportionalFit, fit_proportion, sample_blocks};

/// Correlation above which the ratio of two series can be trusted.
const CERTAIN: f64 = 0.9;
/// Relative tolerance around a factor between units.
const NEAR: f64 = 0.25;
/// Relative disagreement from which a warning is given.
const MODERATE: f64 = 0.1;
const DEGREES: f64 = 180.0 / PI;

/// Compares the change of heading over blocks of samples with the integral of the yaw rate.
pub(crate) fn check_yaw(recording: &Recording, findings: &mut Findings) {
    let (Some(psi), Some(r)) = (recording.channel(Channel::Psi), recording.channel(Channel::R))
    else {
        return;
    };
    let pairs: Vec<(f64, f64)> = sample_blocks(recording)
        .into_iter()
        .map(|block| (block.time_integral(recording.time(), |k| r[k]), block.total_change(psi)))
        .collect();
    let Some(found) = fit_proportion(&pairs) else { return };
    // Without correlation (a constant heading, or noise) the slope has no meaning.
    if found.correlation.abs() < CERTAIN {
        return;
    }
    match unit_mistake(recording, found.slope) {
        Some(message) => findings.error(None, Some(recording.column_header(Channel::R)), message),
        None => report_difference(recording, found, findings),
    }
}

fn unit_mistake(recording: &Recording, slope: f64) -> Option<String> {
    let near = |factor: f64| (slope / factor - 1.0).abs() < NEAR;
    // A factor of 57.3 between both means that one is in degrees and the other in radians.
    let (psi, r) = (recording.column_header(Channel::Psi), recording.column_header(Channel::R));
    let (psi_unit, r_unit) =
        (recording.declared_unit(Channel::Psi), recording.declared_unit(Channel::R));
    if near(DEGREES) {
        return Some(format!(
            "the heading `{psi}` changes 57.3 times as fast as the yaw rate: declare `{psi}` in \
             `deg` if its `{psi_unit}` is wrong, or the yaw rate in `rad/s` if its `{r_unit}` is"
        ));
    }
    if near(1.0 / DEGREES) {
        return Some(format!(
            "the yaw rate is 57.3 times the rate of the heading `{psi}`: declare `{r}` in `deg/s` \
             if its `{r_unit}` is wrong, or the heading in `rad` if its `{psi_unit}` is"
        ));
    }
    near(-1.0).then(|| {
        format!(
            "the yaw rate and the heading `{psi}` have opposite signs; the heading is clockwise \
             from north and the yaw rate positive to starboard: change the sign of one"
        )
    })
}

fn report_difference(recording: &Recording, found: ProportionalFit, findings: &mut Findings) {
    if (found.slope - 1.0).abs() > MODERATE {
        let psi = recording.column_header(Channel::Psi);
        let message = format!(
            "the heading `{psi}` changes {:.2} times as fast as the yaw rate; check both sensors",
            found.slope
        );
        findings.warning(None, Some(recording.column_header(Channel::R)), message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording, zigzag_channels, zigzag_with};

    #[test]
    fn degrees_and_signs_are_told_from_radians() {
        assert_eq!(check_messages(&test_recording(&zigzag_channels()), check_yaw), "");
        assert!(
            check_messages(&zigzag_with(Channel::R, |r| r * DEGREES), check_yaw)
                .contains("declare `r_rad_s` in `deg/s`")
        );
        assert!(
            check_messages(&zigzag_with(Channel::Psi, |psi| psi * DEGREES), check_yaw)
                .contains("declare `psi_rad` in `deg`")
        );
        assert!(
            check_messages(&zigzag_with(Channel::R, |r| -r), check_yaw).contains("opposite signs")
        );
        assert!(
            check_messages(&zigzag_with(Channel::R, |r| 1.2 * r), check_yaw).starts_with("warning")
        );
    }

    #[test]
    fn noise_about_a_straight_course_says_nothing() {
        let noise = |seed: usize| {
            (0..600).map(|k| ((k * 7919 + seed) % 101) as f64 * 1e-5).collect::<Vec<f64>>()
        };
        let straight = test_recording(&[(Channel::Psi, noise(3)), (Channel::R, noise(57))]);
        assert!(!check_messages(&straight, check_yaw).contains("error"));
    }
}
