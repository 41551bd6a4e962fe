//! Check that time increases, and report of its gaps.

use crate::findings::{Findings, Severity};
use crate::recording::Recording;

/// Multiple of the median step from which a step is a gap.
const GAP: f64 = 1.5;

/// Returns true if time is strictly increasing; errors name the rows where it is not.
pub(crate) fn in_order(recording: &Recording, findings: &mut Findings) -> bool {
    let t = recording.time();
    let hits = recording.find_samples(1..t.len(), |k| t[k] <= t[k - 1]);
    findings.report_rows(Severity::Error, &recording.time, &hits, |k| match t[k] == t[k - 1] {
        true => format!("time {} s appears twice; remove one of the rows", t[k]),
        false => format!(
            "time decreases from {} s to {} s; sort the rows, or split the file if it contains \
             two trials",
            t[k - 1],
            t[k]
        ),
    });
    hits.is_empty()
}

/// Warns of gaps and of a start that is not zero. A gap left by excluded rows has been reported
/// already.
pub(crate) fn report_gaps(recording: &Recording, findings: &mut Findings) {
    let (t, limit) = (recording.time(), GAP * recording.interval_s);
    let hits = recording.find_samples(1..t.len(), |k| {
        t[k] - t[k - 1] > limit && recording.resumed.binary_search(&recording.rows[k]).is_err()
    });
    findings.report_rows(Severity::Warning, &recording.time, &hits, |k| {
        format!(
            "gap of {:.3} s (sampling interval {:.3} s); it is not interpolated",
            t[k] - t[k - 1],
            recording.interval_s
        )
    });
    if let Some(&start) = t.first().filter(|start| start.abs() > 1e-9 && !recording.is_stretch) {
        findings.warning(
            Some(recording.row_number(0)),
            Some(&recording.time),
            format!("time starts at {start} s, not at 0; kept as recorded"),
        );
    }
}

#[cfg(test)]
mod tests {
    use sistership_model::trial::Channel;

    use super::*;
    use crate::testing::{check_messages, test_recording};

    fn at(t: &[f64]) -> Recording {
        let mut recording = test_recording(&[(Channel::U, vec![1.0; t.len()])]);
        recording.trial.t_s = t.to_vec();
        recording
    }

    #[test]
    fn time_runs_forwards() {
        let text = check_messages(&at(&[0.0, 1.0, 1.0, 0.5]), |recording, findings| {
            assert!(!in_order(recording, findings))
        });
        assert!(text.contains("error Some(4) Some(\"t_s\") time 1 s appears twice"), "{text}");
        assert!(text.contains("error Some(5)") && text.contains("decreases from 1 s to 0.5 s"));
    }

    #[test]
    fn gaps_and_late_starts_are_told() {
        let mut late = at(&[7.0, 8.0, 9.0, 14.0, 15.0]);
        late.settle_time();
        let text = check_messages(&late, report_gaps);
        assert!(text.contains("warning Some(5)") && text.contains("gap of 5.000 s"), "{text}");
        assert!(text.contains("starts at 7 s"));
    }
}
