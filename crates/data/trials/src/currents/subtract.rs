//! Motion through the water: the recorded one less a current.

use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use super::TrialCurrent;
use crate::findings::Findings;
use crate::recording::Recording;

/// Subtracts a current from velocities over the ground and from positions, so that the trial is as
/// in water at rest.
pub(crate) fn subtract_current(
    recording: &mut Recording,
    current: &TrialCurrent,
    findings: &mut Findings,
) {
    let trial = &mut recording.trial;
    let Some(psi) = trial.channel(Channel::Psi).map(<[f64]>::to_vec) else {
        let message = "a current is declared, but without a heading it cannot be subtracted: map \
                       the column of `psi`, or remove the entry of `currents`";
        return findings.error(None, None, message);
    };
    let (north, east) = (current.north_m_s, current.east_m_s);
    let water = trial.velocity == VelocityFrame::Water;
    // A channel that was not recorded stays so.
    let mut subtract = |channel: Channel, amount: &dyn Fn(usize) -> f64| {
        let values = trial.channels.get_mut(&channel).into_iter().flatten();
        values.enumerate().for_each(|(k, value)| *value -= amount(k));
    };
    if !water {
        // Rotated into the ship's axes: a current ahead adds to the speed over the ground.
        subtract(Channel::U, &|k| north * psi[k].cos() + east * psi[k].sin());
        subtract(Channel::V, &|k| east * psi[k].cos() - north * psi[k].sin());
    }
    // Positions keep their first value: what the water has carried is counted from there.
    let t_s = std::mem::take(&mut recording.trial.t_s);
    let start = t_s.first().copied().unwrap_or_default();
    for (channel, speed) in [(Channel::X, north), (Channel::Y, east)] {
        let values = recording.trial.channels.get_mut(&channel).into_iter().flatten();
        values.zip(&t_s).for_each(|(value, t)| *value -= speed * (t - start));
    }
    recording.trial.t_s = t_s;
    let message = format!(
        "velocities and positions are through the water: a current of {} is subtracted ({})",
        current.summary_text(),
        current.why
    );
    findings.warning(None, None, message);
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::testing::{finding_messages, test_recording};

    fn current() -> TrialCurrent {
        TrialCurrent { trial: "a".into(), north_m_s: 0.3, east_m_s: 0.4, why: "drift".into() }
    }

    #[test]
    fn speeds_and_positions_become_those_in_water_at_rest() {
        let mut ship = test_recording(&[
            (Channel::Psi, vec![FRAC_PI_2; 3]),
            (Channel::U, vec![5.4; 3]),
            (Channel::V, vec![-0.3; 3]),
            (Channel::X, vec![0.0, 0.15, 0.3]),
            (Channel::Y, vec![0.0, 2.7, 5.4]),
        ]);
        let mut findings = Findings::default();
        subtract_current(&mut ship, &current(), &mut findings);
        let at = |channel, k: usize| ship.trial.channels[&channel][k];
        assert!((at(Channel::U, 1) - 5.0).abs() < 1e-12 && at(Channel::V, 1).abs() < 1e-12);
        assert!(at(Channel::X, 2).abs() < 1e-12 && (at(Channel::Y, 2) - 5.0).abs() < 1e-12);
        let text = finding_messages(findings);
        assert!(text.contains("0.50 m/s towards 53 deg"), "{text}");
    }

    #[test]
    fn without_a_heading_the_trial_is_refused() {
        let mut ship = test_recording(&[(Channel::U, vec![5.0; 3])]);
        let mut findings = Findings::default();
        subtract_current(&mut ship, &current(), &mut findings);
        assert!(findings.has_errors());
    }
}
