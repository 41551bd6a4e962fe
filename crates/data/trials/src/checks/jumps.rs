//! Check for steps between two samples that are impossible for a ship, with a margin for
//! instruments.

use std::f64::consts::PI;

use sistership_model::trial::Channel;

use crate::findings::{Findings, Severity};
use crate::recording::Recording;
use crate::stats::nearest_quantile;

/// m/s; faster than any ship.
const MAX_SPEED: f64 = 40.0;
/// m; a step of a satellite fix without any motion.
const FIX_STEP: f64 = 10.0;
/// rad; a heading step between two samples, and the rate (rad/s) that widens it for long sampling
/// intervals.
const HEADING_STEP: f64 = PI / 3.0;
const HEADING_RATE: f64 = 0.1;
/// m/s and m/s2; a step of a speed sensor, and an acceleration beyond any ship's.
const SPEED_STEP: f64 = 5.0;
const ACCELERATION: f64 = 2.0;
/// Largest fraction of positions that jump, and their number in a short trial: with more, the column
/// or its unit is wrong, and the trial is refused.
const MAX_JUMPS: f64 = 0.01;
const FEW_JUMPS: usize = 4;
/// Multiple of the usual position step from which a step is reported.
const UNUSUAL: f64 = 10.0;

pub(crate) fn check_jumps(recording: &Recording, findings: &mut Findings) {
    check_position(recording, findings);
    check_heading(recording, findings);
    for channel in [Channel::U, Channel::V, Channel::UWater, Channel::VWater] {
        check_speed(recording, channel, findings);
    }
}

/// Skips the row at each jump of the position if these are few, so that a segment ends there and
/// nothing is fitted across it.
pub(crate) fn split_at_jumps(recording: &mut Recording, findings: &mut Findings) {
    let Some(steps) = PositionSteps::new(recording) else { return };
    let samples = 1..recording.trial.len();
    let jumps: Vec<usize> = samples.clone().filter(|&k| steps.is_new_jump(k)).collect();
    if jumps.is_empty() || jumps.len() > FEW_JUMPS.max((MAX_JUMPS * steps.t.len() as f64) as usize)
    {
        return;
    }
    let hits = recording.find_samples(samples, |k| steps.is_new_jump(k));
    findings.report_rows(Severity::Warning, recording.column_header(Channel::X), &hits, |k| {
        format!(
            "the position jumps {:.1} m in {:.3} s: the row is skipped, and the trial is not fitted \
             across it",
            steps.step(k),
            steps.interval(k)
        )
    });
    let ranges: Vec<_> = jumps.into_iter().map(|k| k..k + 1).collect();
    recording.leave_out(&ranges);
    recording.settle_time();
}

/// Steps between the positions of neighbouring samples.
struct PositionSteps<'a> {
    recording: &'a Recording,
    t: &'a [f64],
    x: &'a [f64],
    y: &'a [f64],
}

impl<'a> PositionSteps<'a> {
    fn new(recording: &'a Recording) -> Option<Self> {
        let (x, y) = (recording.channel(Channel::X)?, recording.channel(Channel::Y)?);
        Some(Self { recording, t: recording.time(), x, y })
    }

    fn step(&self, k: usize) -> f64 {
        (self.x[k] - self.x[k - 1]).hypot(self.y[k] - self.y[k - 1])
    }

    fn interval(&self, k: usize) -> f64 {
        self.t[k] - self.t[k - 1]
    }

    fn is_jump(&self, k: usize) -> bool {
        self.step(k) > FIX_STEP + MAX_SPEED * self.interval(k)
    }

    /// Returns true for a jump at which no segment begins.
    fn is_new_jump(&self, k: usize) -> bool {
        self.is_jump(k) && !self.begins_segment(k)
    }

    fn begins_segment(&self, k: usize) -> bool {
        self.recording.segments.iter().any(|segment| segment.start == k)
    }
}

fn check_position(recording: &Recording, findings: &mut Findings) {
    let Some(steps) = PositionSteps::new(recording) else { return };
    let (samples, header) = (1..steps.t.len(), recording.column_header(Channel::X));
    // Segments begin at a gap, and nothing is fitted across it.
    let gaps =
        recording.find_samples(samples.clone(), |k| steps.is_jump(k) && steps.begins_segment(k));
    findings.report_rows(Severity::Warning, header, &gaps, |k| {
        format!(
            "the position jumps {:.1} m across a gap; the trial is not fitted across it",
            steps.step(k)
        )
    });
    let hits = recording.find_samples(samples, |k| steps.is_new_jump(k));
    findings.report_rows(Severity::Error, header, &hits, |k| {
        format!(
            "the position jumps {:.1} m in {:.3} s; remove the faulty fix, or split the file there",
            steps.step(k),
            steps.interval(k)
        )
    });
    if hits.is_empty() {
        report_unusual_steps(recording, |k| steps.step(k), findings);
    }
}

/// Reports steps of a satellite fix, which are kept: the largest and their number.
fn report_unusual_steps(
    recording: &Recording,
    step: impl Fn(usize) -> f64,
    findings: &mut Findings,
) {
    // The 95 % quantile is the usual step; only steps within segments are reported.
    let typical = nearest_quantile((1..recording.trial.len()).map(&step), 0.95);
    let steady = recording.segments.iter().flat_map(|segment| segment.start + 1..segment.end);
    let unusual = steady.filter(|&k| step(k) > UNUSUAL * typical && typical > 0.0);
    let mut count = 0;
    if let Some(largest) =
        unusual.inspect(|_| count += 1).max_by(|&a, &b| step(a).total_cmp(&step(b)))
    {
        let message = format!(
            "the position steps {:.2} m here, while 95 % of steps are below {typical:.3} m \
             ({count} such steps); this is common with satellite positions",
            step(largest)
        );
        findings.warning(
            Some(recording.row_number(largest)),
            Some(recording.column_header(Channel::X)),
            message,
        );
    }
}

fn check_heading(recording: &Recording, findings: &mut Findings) {
    let Some(psi) = recording.channel(Channel::Psi) else { return };
    let (t, header) = (recording.time(), recording.column_header(Channel::Psi));
    // Steps across gaps are not checked.
    let within = |k: usize| !recording.segments.iter().any(|segment| segment.start == k);
    let limit = |k: usize| HEADING_STEP.max(HEADING_RATE * (t[k] - t[k - 1]));
    let hits =
        recording.find_samples(1..t.len(), |k| (psi[k] - psi[k - 1]).abs() > limit(k) && within(k));
    findings.report_rows(Severity::Error, header, &hits, |k| {
        let degrees = (psi[k] - psi[k - 1]) * 180.0 / PI;
        format!(
            "the heading steps {degrees:.0} deg in {:.3} s; if its unit is degrees declare `deg`, \
             otherwise remove the row",
            t[k] - t[k - 1]
        )
    });
}

fn check_speed(recording: &Recording, channel: Channel, findings: &mut Findings) {
    let Some(values) = recording.channel(channel) else { return };
    let (t, header) = (recording.time(), recording.column_header(channel));
    let step = |k: usize| values[k] - values[k - 1];
    let hits = recording.find_samples(1..t.len(), |k| {
        step(k).abs() > SPEED_STEP + ACCELERATION * (t[k] - t[k - 1])
    });
    findings.report_rows(Severity::Error, header, &hits, |k| {
        format!(
            "the speed changes by {:.2} m/s in {:.3} s, which is impossible; remove the faulty row",
            step(k),
            t[k] - t[k - 1]
        )
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording, zigzag_channels};

    #[test]
    fn a_steady_run_passes() {
        assert_eq!(check_messages(&test_recording(&zigzag_channels()), check_jumps), "");
    }

    #[test]
    fn impossible_steps_name_their_row() {
        let broken = |channel: Channel, by: f64| {
            let mut channels = zigzag_channels();
            channels
                .iter_mut()
                .filter(|(name, _)| *name == channel)
                .for_each(|(_, values)| values[100] += by);
            check_messages(&test_recording(&channels), check_jumps)
        };
        assert!(
            broken(Channel::X, 60.0)
                .starts_with("error Some(102) Some(\"x_m\") the position jumps")
        );
        assert!(
            broken(Channel::Psi, 1.2)
                .starts_with("error Some(102) Some(\"psi_rad\") the heading steps")
        );
        assert!(
            broken(Channel::U, 8.0)
                .starts_with("error Some(102) Some(\"u_m_s\") the speed changes")
        );
        // A satellite fix that steps is the seafarer's daily bread.
        let text = broken(Channel::X, 27.0);
        assert!(
            text.starts_with("warning Some(10") && text.contains("satellite positions"),
            "{text}"
        );
    }
}
