//! Checks of a recording before a model is fitted to it.

mod course;
mod jumps;
mod ranges;
mod rudder;
mod shape;
mod time;
mod track;
mod yaw;

use crate::findings::Findings;
use crate::recording::Recording;

/// Runs every check. Those that need increasing time are skipped if time does not increase.
pub(crate) fn run_checks(recording: &mut Recording, findings: &mut Findings) {
    shape::check_shape(recording, findings);
    ranges::check_ranges(recording, findings);
    if !time::in_order(recording, findings) {
        return;
    }
    // Sampling interval and segments are only defined once time increases; the checks below use
    // them.
    recording.settle_time();
    jumps::split_at_jumps(recording, findings);
    time::report_gaps(recording, findings);
    jumps::check_jumps(recording, findings);
    yaw::check_yaw(recording, findings);
    course::check_course(recording, findings);
    track::check_track(recording, findings);
    rudder::check_rudder(recording, findings);
}
