//! Speeds through the water: a separate measurement if there are speeds over the ground, and
//! otherwise the velocities of the trial.

use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;

/// Speed through the water, with the channel of the same axis over the ground.
const AXES: [(Channel, Channel); 2] =
    [(Channel::UWater, Channel::U), (Channel::VWater, Channel::V)];

/// Returns true if an axis has a speed through the water and none over the ground.
pub(crate) fn is_water_only(recording: &Recording, ground: Channel) -> bool {
    let has = |channel| recording.channel(channel).is_some();
    AXES.iter().any(|&(water, own)| own == ground && has(water) && !has(own))
}

/// Determines `u` and `v` of the trial: over the ground if those are known, otherwise through the
/// water.
pub(crate) fn assign_velocities(recording: &mut Recording, findings: &mut Findings) {
    let has = |channel| recording.channel(channel).is_some();
    // Findings refer to the first speed through the water that was recorded.
    let Some(&(log, _)) = AXES.iter().find(|(water, _)| has(*water)) else { return };
    if has(Channel::U) {
        let message = "there are speeds through the water and over the ground: their difference \
                       is a current or an error of the log";
        return findings.warning(None, Some(recording.column_header(log)), message);
    }
    if has(Channel::V) {
        let message = "is assumed to be through the water, because it is the only speed ahead; if \
                       it is over the ground, map position and heading and declare `derive: [u]`";
        findings.warning(None, Some(recording.column_header(Channel::V)), message);
    }
    let message = "u and v are speeds through the water, and there are none over the ground: a \
                   current is visible in the positions only";
    findings.warning(None, Some(recording.column_header(log)), message);
    AXES.iter().for_each(|&axis| move_channel(recording, axis));
    recording.trial.velocity = VelocityFrame::Water;
}

fn move_channel(recording: &mut Recording, (water, own): (Channel, Channel)) {
    if let Some(values) = recording.trial.channels.remove(&water) {
        recording.trial.channels.insert(own, values);
    }
    if let Some(column) = recording.columns.remove(&water) {
        recording.columns.insert(own, column);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_recording};

    fn settled(channels: &[(Channel, f64)]) -> (Recording, String) {
        let channels: Vec<_> =
            channels.iter().map(|&(channel, value)| (channel, vec![value; 3])).collect();
        let (mut ship, mut findings) = (test_recording(&channels), Findings::default());
        assign_velocities(&mut ship, &mut findings);
        (ship, finding_messages(findings))
    }

    #[test]
    fn a_log_stays_beside_velocities_over_the_ground() {
        let (ship, text) = settled(&[(Channel::U, 4.0), (Channel::V, 0.0), (Channel::UWater, 5.0)]);
        let at = |channel| ship.trial.channels[&channel][0];
        assert_eq!((at(Channel::U), at(Channel::UWater)), (4.0, 5.0));
        assert_eq!(ship.trial.velocity, VelocityFrame::Ground);
        assert!(
            text.contains(
                "Some(\"u_water_m_s\") there are speeds through the water and over \
                               the ground"
            ),
            "{text}"
        );
    }

    #[test]
    fn a_log_alone_gives_the_velocities_through_the_water() {
        let (ship, text) = settled(&[(Channel::UWater, 5.0), (Channel::VWater, 0.2)]);
        let at = |channel| ship.trial.channels[&channel][0];
        assert_eq!((at(Channel::U), at(Channel::V)), (5.0, 0.2));
        assert_eq!(ship.trial.velocity, VelocityFrame::Water);
        assert_eq!(ship.trial.channels.len(), 2);
        assert!(text.contains("a current is visible in the positions only"), "{text}");
        assert!(settled(&[(Channel::UWater, 5.0), (Channel::V, 0.2)]).1.contains("derive: [u]"));
    }
}
