//! Conversion of course and speed over ground, and of velocities north and east, to surge and sway
//! velocity.

use sistership_model::trial::Channel;

use crate::declarations::Antenna;
use crate::findings::Findings;
use crate::recording::Recording;
use crate::table::RawQuantity;

/// Computes `u` and `v` from course, speed and heading, where they were not measured.
pub(crate) fn ground_velocities(
    recording: &mut Recording,
    antenna: Option<Antenna>,
    findings: &mut Findings,
) {
    earth_velocities(recording, findings);
    let given =
        (recording.raw.remove(&RawQuantity::Course), recording.raw.remove(&RawQuantity::Speed));
    if given == (None, None) {
        return;
    }
    let (Some(course), Some(speed), Some(psi)) =
        (given.0, given.1, recording.channel(Channel::Psi))
    else {
        let message =
            "u and v need course, speed and heading; one of them is missing, so that none is used";
        return findings.warning(None, None, message);
    };
    if [Channel::U, Channel::V].iter().any(|&channel| recording.channel(channel).is_some()) {
        let message = "u or v is measured; course and speed over ground are not used";
        return findings.warning(None, None, message);
    }
    let drift = course.iter().zip(psi).map(|(course, psi)| course - psi);
    let (mut u, mut v): (Vec<f64>, Vec<f64>) =
        drift.zip(&speed).map(|(drift, speed)| (speed * drift.cos(), speed * drift.sin())).unzip();
    let mut of = "of the antenna";
    match (antenna, recording.channel(Channel::R)) {
        (Some(antenna), Some(r)) => {
            // Rigid-body motion: the antenna at (x, y) moves by (-r y, r x) relative to midship.
            for ((u, v), r) in u.iter_mut().zip(&mut v).zip(r) {
                *u += r * antenna.y_m;
                *v -= r * antenna.x_m;
            }
            of = "of midship, by the antenna's offset and r";
        }
        (Some(_), None) => of = "of the antenna, because r is missing to move them to midship",
        _ => {}
    }
    let message = format!(
        "u and v are computed from course and speed over ground and heading; they are {of}"
    );
    findings.warning(None, None, message);
    recording.trial.channels.insert(Channel::U, u);
    recording.trial.channels.insert(Channel::V, v);
}

/// Computes `u` and `v` from velocities north and east, where they were not measured.
fn earth_velocities(recording: &mut Recording, findings: &mut Findings) {
    let given =
        (recording.raw.remove(&RawQuantity::VNorth), recording.raw.remove(&RawQuantity::VEast));
    if given == (None, None) {
        return;
    }
    let (Some(north), Some(east), Some(psi)) = (given.0, given.1, recording.channel(Channel::Psi))
    else {
        let message = "u and v need velocities north and east and the heading; one of them is \
                       missing, so that none is used";
        return findings.warning(None, None, message);
    };
    if [Channel::U, Channel::V].iter().any(|&channel| recording.channel(channel).is_some()) {
        let message = "u or v is measured; velocities north and east are not used";
        return findings.warning(None, None, message);
    }
    let turned = north.iter().zip(&east).zip(psi).map(|((north, east), psi)| {
        let (sin, cos) = psi.sin_cos();
        (north * cos + east * sin, east * cos - north * sin)
    });
    let (u, v): (Vec<f64>, Vec<f64>) = turned.unzip();
    let message = "u and v are computed from velocities north and east and the heading";
    findings.warning(None, None, message);
    recording.trial.channels.insert(Channel::U, u);
    recording.trial.channels.insert(Channel::V, v);
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::testing::{finding_messages, test_recording};

    fn ship(antenna: Option<Antenna>) -> (Recording, String) {
        let mut ship =
            test_recording(&[(Channel::Psi, vec![FRAC_PI_2; 3]), (Channel::R, vec![0.01; 3])]);
        ship.raw.insert(RawQuantity::Course, vec![FRAC_PI_2 + 0.1; 3]);
        ship.raw.insert(RawQuantity::Speed, vec![5.0; 3]);
        let mut findings = Findings::default();
        ground_velocities(&mut ship, antenna, &mut findings);
        (ship, finding_messages(findings))
    }

    #[test]
    fn a_course_to_starboard_of_the_heading_is_sway_to_starboard() {
        let (plain, text) = ship(None);
        let at = |ship: &Recording, channel| ship.trial.channels[&channel][0];
        assert!((at(&plain, Channel::U) - 5.0 * 0.1_f64.cos()).abs() < 1e-12);
        assert!((at(&plain, Channel::V) - 5.0 * 0.1_f64.sin()).abs() < 1e-12);
        assert!(text.contains("they are of the antenna"), "{text}");
        let (moved, _) = ship(Some(Antenna { x_m: 20.0, y_m: 3.0 }));
        assert!((at(&moved, Channel::V) - at(&plain, Channel::V) + 0.2).abs() < 1e-12);
        assert!((at(&moved, Channel::U) - at(&plain, Channel::U) - 0.03).abs() < 1e-12);
    }

    #[test]
    fn without_a_heading_nothing_is_made_up() {
        let mut ship = test_recording(&[(Channel::R, vec![0.01; 3])]);
        ship.raw.insert(RawQuantity::Speed, vec![5.0; 3]);
        let mut findings = Findings::default();
        ground_velocities(&mut ship, None, &mut findings);
        assert!(finding_messages(findings).contains("one of them is missing"));
        assert_eq!(ship.trial.channels.len(), 1);
    }
}
