//! Segment of a log, and the reason of its selection.

use serde::Serialize;

use crate::segmentation::active::Activity;
use crate::segmentation::cells::{Cell, Cells};
use crate::segmentation::excitation::Excitation;
use crate::segmentation::kind::{Hold, Kind, Observed, holds};
use crate::segmentation::level::Levels;
use crate::segmentation::spans::Span;
use crate::segmentation::thresholds::KINDS;
use std::ops::Range;

/// Segment in which the controls move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stretch {
    /// Span with a steady approach, until the ship is steady again.
    #[serde(flatten)]
    pub span: Span,
    /// Most likely manoeuvre.
    pub kind: Kind,
    /// Excitation.
    pub excitation: Excitation,
    /// Reason of the selection, in words.
    pub why: String,
}

impl Stretch {
    /// Creates a segment of the cells from the first movement to the last response; `span` includes
    /// the time before and after.
    pub(crate) fn of(
        cells: &Cells,
        levels: &Levels,
        activity: &Activity,
        range: &Range<usize>,
        span: Span,
    ) -> Self {
        let (inner, steady) = (&cells.all[range.clone()], levels.at(range.start));
        let limit = activity.rudder_limit(range.start);
        let holds = holds(inner, steady.rudder, limit);
        // Speed and revolutions one length before the first movement, as the reference of the
        // manoeuvre.
        let before = &cells.all[range.start.saturating_sub(cells.count(1.0).max(1))];
        let observed = Observed {
            cells: inner,
            holds: &holds,
            steady,
            yaw_limit: activity.yaw_limit(range.start, cells.limits.answer),
            rudder_limit: limit,
            speed: before.speed,
            revolutions: before.revolutions,
            pull_out: cells.count(KINDS.pull_out),
        };
        let kind = observed.kind();
        // Consecutive holds are on alternate sides: one reversal between two.
        let reversals = holds.len().saturating_sub(1);
        let excitation = Excitation::of(inner, &steady, reversals, cells.scale.speed_m_s);
        let why = why(kind, inner, &holds, &excitation, before);
        let scatter = steady.rudder_scatter.to_degrees();
        let why = format!("{why}; in course keeping the rudder scatters by {scatter:.1} deg");
        Self { span, kind, excitation, why }
    }
}

fn why(
    kind: Kind,
    cells: &[Cell],
    holds: &[Hold],
    excitation: &Excitation,
    before: &Cell,
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
        Kind::Zigzag => format!(
            "rudder {low:.0} to {high:+.0} deg, to the other side {} times, yaw rate to {yaw:.2} \
             deg/s",
            excitation.rudder_reversals
        ),
        Kind::PullOut => {
            format!(
                "{rudder}, then amidships while the ship turns on; heading over {turned:.0} deg"
            )
        }
        Kind::Stop | Kind::SpeedChange => {
            let last = cells.last().map_or(before.revolutions, |cell| cell.revolutions);
            let range = cells.iter().map(|cell| cell.revolutions).fold(last, f64::min);
            format!(
                "revolutions {:.2} to {:.2} 1/s (least {range:.2}), speed over {lost:.0} % of its \
                 usual",
                before.revolutions, last
            )
        }
        Kind::Turn | Kind::CourseChange | Kind::RudderMovement => format!(
            "{rudder}, heading over {turned:.0} deg, yaw rate to {yaw:.2} deg/s, speed over \
             {lost:.0} %"
        ),
    }
}
