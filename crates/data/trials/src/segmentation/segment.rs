//! Segment of a log, and the reason of its selection.

use serde::Serialize;

use crate::segmentation::active::CellActivity;
use crate::segmentation::cells::{LogCell, LogCells};
use crate::segmentation::excitation::Excitation;
use crate::segmentation::kind::{ManoeuvreData, RudderHold, SegmentKind, find_holds};
use crate::segmentation::level::SteadyLevels;
use crate::segmentation::spans::TimeSpan;
use crate::segmentation::thresholds::KINDS;
use std::ops::Range;

/// Segment in which the controls move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ManoeuvreSegment {
    /// Span with a steady approach, until the ship is steady again.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Most likely manoeuvre.
    pub kind: SegmentKind,
    /// Excitation.
    pub excitation: Excitation,
    /// Reason of the selection, in words.
    pub why: String,
}

impl ManoeuvreSegment {
    /// Creates a segment of the cells from the first movement to the last response; `span` includes
    /// the time before and after.
    pub(crate) fn from_cells(
        cells: &LogCells,
        levels: &SteadyLevels,
        activity: &CellActivity,
        range: &Range<usize>,
        span: TimeSpan,
    ) -> Self {
        let (inner, steady) = (&cells.all[range.clone()], levels.level_at(range.start));
        let limit = activity.rudder_limit(range.start);
        let holds = find_holds(inner, steady.rudder, limit);
        // Speed and revolutions one length before the first movement, as the reference of the
        // manoeuvre.
        let before = &cells.all[range.start.saturating_sub(cells.cell_count(1.0).max(1))];
        let observed = ManoeuvreData {
            cells: inner,
            holds: &holds,
            steady,
            yaw_limit: activity.yaw_limit(range.start, cells.limits.answer),
            rudder_limit: limit,
            speed: before.speed,
            revolutions: before.revolutions,
            pull_out: cells.cell_count(KINDS.pull_out),
        };
        let kind = observed.classify_manoeuvre();
        // Consecutive holds are on alternate sides: one reversal between two.
        let reversals = holds.len().saturating_sub(1);
        let excitation = Excitation::from_cells(inner, &steady, reversals, cells.scale.speed_m_s);
        let why = describe_reason(kind, inner, &holds, &excitation, before);
        let scatter = steady.rudder_scatter.to_degrees();
        let why = format!(
            "{why}; standard deviation of the rudder in course keeping {scatter:.1} \
                           deg"
        );
        Self { span, kind, excitation, why }
    }
}

fn describe_reason(
    kind: SegmentKind,
    cells: &[LogCell],
    holds: &[RudderHold],
    excitation: &Excitation,
    before: &LogCell,
) -> String {
    let (low, high) = (excitation.rudder_low_deg, excitation.rudder_high_deg);
    let (turned, yaw) = (excitation.heading_range_deg, excitation.yaw_rate_max_deg_s);
    let lost = 100.0 * excitation.speed_range;
    let rudder = match holds.first() {
        Some(hold) if hold.to_starboard => format!("rudder {high:.0} deg to starboard"),
        Some(_) => format!("rudder {:.0} deg to port", -low),
        None => "rudder amidships".to_owned(),
    };
    match kind {
        SegmentKind::Zigzag => format!(
            "rudder {low:.0} to {high:+.0} deg with {} reversals, yaw rate up to {yaw:.2} deg/s",
            excitation.rudder_reversals
        ),
        SegmentKind::PullOut => {
            format!(
                "{rudder}, then amidships while the ship continues to turn; heading changes by \
                 {turned:.0} deg"
            )
        }
        SegmentKind::Stop | SegmentKind::SpeedChange => {
            let last = cells.last().map_or(before.revolutions, |cell| cell.revolutions);
            let range = cells.iter().map(|cell| cell.revolutions).fold(last, f64::min);
            format!(
                "revolutions {:.2} to {:.2} 1/s (minimum {range:.2}), speed varies by {lost:.0} %",
                before.revolutions, last
            )
        }
        SegmentKind::Turn | SegmentKind::CourseChange | SegmentKind::RudderMovement => format!(
            "{rudder}, heading changes by {turned:.0} deg, yaw rate up to {yaw:.2} deg/s, speed \
             varies by {lost:.0} %"
        ),
    }
}
