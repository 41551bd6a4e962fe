//! Check that a recording is long enough and its channels change.

use std::f64::consts::TAU;

use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;
use crate::stats::value_range;

/// Minimum number of samples of a trial.
const FEWEST: usize = 3;
/// Fraction of a full turn that counts as a full turn.
const ALMOST: f64 = 0.98;

pub(crate) fn check_shape(recording: &Recording, findings: &mut Findings) {
    if recording.trial.len() < FEWEST {
        let message = format!(
            "{} usable rows are too few for a trial; at least {FEWEST} are needed",
            recording.trial.len()
        );
        findings.error(None, None, message);
        return;
    }
    report_constant(recording, findings);
    short_turn(recording, findings);
}

/// Warns of a channel that never changes, a dead sensor or a placeholder; depth may be constant.
fn report_constant(recording: &Recording, findings: &mut Findings) {
    for (&channel, values) in &recording.trial.channels {
        if channel != Channel::Depth && value_range(values) == 0.0 {
            findings.warning(
                None,
                Some(recording.column_header(channel)),
                format!(
                    "constant at {:.4} {} throughout",
                    values[0],
                    recording.canonical_unit(channel)
                ),
            );
        }
    }
}

/// Warns of a turning circle of less than a full turn.
fn short_turn(recording: &Recording, findings: &mut Findings) {
    if !is_turn(recording) {
        return;
    }
    let turned = match (recording.channel(Channel::Psi), recording.channel(Channel::R)) {
        (Some(psi), _) => value_range(psi),
        (None, Some(r)) => {
            let t = recording.time();
            (1..r.len()).map(|k| r[k] * (t[k] - t[k - 1])).sum::<f64>().abs()
        }
        (None, None) => return,
    };
    if turned < ALMOST * TAU {
        let message = format!(
            "the turn is too short: the heading changes by {:.0} deg, but a turning circle needs \
             360 deg or more",
            turned.to_degrees()
        );
        findings.warning(None, Some(recording.column_header(Channel::Psi)), message);
    }
}

fn is_turn(recording: &Recording) -> bool {
    // By the declared manoeuvre, otherwise by the name of the file.
    let file = recording.trial.name.rsplit(['/', '\\']).next().unwrap_or_default();
    let text = recording.trial.manoeuvre.as_deref().unwrap_or(file).to_lowercase();
    text.split(|c: char| !c.is_alphanumeric()).any(|word| matches!(word, "turn" | "turning"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording};

    #[test]
    fn a_constant_channel_and_a_short_turn_are_told() {
        let mut turn = test_recording(&[
            (Channel::Psi, vec![0.0, 0.5, 1.0]),
            (Channel::N, vec![2.0; 3]),
            (Channel::Depth, vec![9.0; 3]),
        ]);
        assert!(!check_messages(&turn, check_shape).contains("too short"));
        turn.trial.manoeuvre = Some("turn 35 deg".into());
        let text = check_messages(&turn, check_shape);
        assert!(
            text.contains("Some(\"n_rps\") constant at 2.0000 rps")
                && text.contains("heading changes by 57 deg"),
            "{text}"
        );
        assert!(!text.contains("depth"));
    }

    #[test]
    fn two_rows_are_no_trial() {
        assert!(
            check_messages(&test_recording(&[(Channel::U, vec![1.0, 2.0])]), check_shape)
                .starts_with("error")
        );
    }
}
