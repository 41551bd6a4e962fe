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
pub(crate) fn run(recording: &mut Recording, findings: &mut Findings) {
    shape::check(recording, findings);
    ranges::check(recording, findings);
    if !time::in_order(recording, findings) {
        return;
    }
    // Sampling interval and segments are only defined once time increases; the checks below use
    // them.
    recording.settle_time();
    time::gaps(recording, findings);
    jumps::check(recording, findings);
    yaw::check(recording, findings);
    course::check(recording, findings);
    track::check(recording, findings);
    rudder::check(recording, findings);
}
