//! Rudders and propellers of twin-screw ships: a trial has a channel of either side, and their mean.

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;

/// Channel of the mean, and those of starboard and port.
const PAIRS: [(Channel, Channel, Channel); 2] =
    [(Channel::Delta, Channel::DeltaS, Channel::DeltaP), (Channel::N, Channel::NS, Channel::NP)];

/// Returns the mean of each pair; reports the largest difference of the sides. A side without the
/// other stands for both, and is no channel of its own.
pub(crate) fn pair_means(
    recording: &mut Recording,
    findings: &mut Findings,
) -> Vec<(Channel, Vec<f64>)> {
    PAIRS.iter().filter_map(|&pair| pair_mean(pair, recording, findings)).collect()
}

fn pair_mean(
    (channel, starboard, port): (Channel, Channel, Channel),
    recording: &mut Recording,
    findings: &mut Findings,
) -> Option<(Channel, Vec<f64>)> {
    let (message, values) = match (recording.channel(starboard), recording.channel(port)) {
        (Some(one), Some(other)) => {
            let apart = largest_difference(one, other);
            let mean = one.iter().zip(other).map(|(one, other)| 0.5 * (one + other));
            let unit = recording.canonical_unit(channel);
            let message = format!(
                "is the mean of starboard and port, which are up to {apart:.4} {unit} apart"
            );
            (message, mean.collect())
        }
        (None, None) => return None,
        (one, _) => {
            let (alone, side) =
                if one.is_some() { (starboard, "starboard") } else { (port, "port") };
            let values = recording.trial.channels.remove(&alone)?;
            (format!("is that of the {side} side only"), values)
        }
    };
    if recording.channel(channel).is_some() {
        let message = "the common column is read; those of starboard and port are not";
        findings.warning(None, Some(channel.name()), message);
        return None;
    }
    findings.warning(None, Some(channel.name()), message);
    Some((channel, values))
}

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0, |most, (one, other)| (one - other).abs().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_recording};

    #[test]
    fn a_pair_gives_its_mean_and_one_side_itself() {
        let mut ship = test_recording(&[(Channel::U, vec![1.0; 3])]);
        ship.trial.channels.extend([
            (Channel::DeltaS, vec![0.1, 0.2, 0.3]),
            (Channel::DeltaP, vec![0.3, 0.2, 0.1]),
            (Channel::NP, vec![2.0; 3]),
        ]);
        let mut findings = Findings::default();
        let means = pair_means(&mut ship, &mut findings);
        assert_eq!(means[1], (Channel::N, vec![2.0; 3]));
        assert!(means[0].1.iter().all(|value| (value - 0.2).abs() < 1e-12));
        assert!(ship.channel(Channel::DeltaP).is_some() && ship.channel(Channel::NP).is_none());
        let text = finding_messages(findings);
        assert!(text.contains("up to 0.2000 rad apart") && text.contains("port side only"));
    }

    #[test]
    fn a_channel_of_its_own_goes_before_the_pair() {
        let mut ship = test_recording(&[(Channel::Delta, vec![0.1; 3])]);
        let sides = [Channel::DeltaS, Channel::DeltaP].map(|side| (side, vec![0.2; 3]));
        ship.trial.channels.extend(sides);
        assert!(pair_means(&mut ship, &mut Findings::default()).is_empty());
    }
}
