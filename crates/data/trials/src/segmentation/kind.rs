//! Classification of the manoeuvre in a segment by its controls and the response of the ship.

use std::fmt;

use serde::Serialize;

use crate::segmentation::cells::LogCell;
use crate::segmentation::excitation::heading_range;
use crate::segmentation::level::SteadyLevel;
use crate::segmentation::thresholds::KINDS;

/// Manoeuvre that a segment most resembles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentKind {
    /// The rudder goes from side to side.
    Zigzag,
    /// The rudder is held for half a turn or more.
    Turn,
    /// The rudder goes amidships while the ship turns on.
    PullOut,
    /// The propeller stops or is reversed, and the ship loses its way.
    Stop,
    /// The revolutions change, the rudder does not.
    SpeedChange,
    /// The heading changes by less than half a turn.
    CourseChange,
    /// The rudder moves, and the heading returns.
    RudderMovement,
}

impl fmt::Display for SegmentKind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Zigzag => "zigzag",
            Self::Turn => "turn",
            Self::PullOut => "pull-out",
            Self::Stop => "stop",
            Self::SpeedChange => "speed change",
            Self::CourseChange => "course change",
            Self::RudderMovement => "rudder movement",
        })
    }
}

/// Cells in which the rudder is held to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RudderHold {
    pub from: usize,
    pub to: usize,
    pub to_starboard: bool,
}

/// Returns the runs of cells with large rudder angles, one for each change of side.
pub(crate) fn find_holds(cells: &[LogCell], level: f64, limit: f64) -> Vec<RudderHold> {
    let largest = cells.iter().map(|cell| (cell.rudder - level).abs()).fold(0.0, f64::max);
    if largest <= limit {
        return Vec::new();
    }
    // Small angles between two holds, such as meeting a turn, are not holds.
    let least = limit.max(KINDS.hold * largest);
    let mut holds: Vec<RudderHold> = Vec::new();
    for (at, cell) in cells.iter().enumerate() {
        let angle = cell.rudder - level;
        if angle.abs() <= least {
            continue;
        }
        let to_starboard = angle > 0.0;
        match holds.last_mut().filter(|hold| hold.to_starboard == to_starboard) {
            Some(hold) => hold.to = at + 1,
            None => holds.push(RudderHold { from: at, to: at + 1, to_starboard }),
        }
    }
    holds
}

/// Data of a manoeuvre by which it is classified.
pub(crate) struct ManoeuvreData<'a> {
    pub cells: &'a [LogCell],
    pub holds: &'a [RudderHold],
    pub steady: SteadyLevel,
    /// Yaw rate above which the ship turns, rad/s.
    pub yaw_limit: f64,
    /// Angle up to which the rudder is amidships, rad.
    pub rudder_limit: f64,
    /// Speed and revolutions before the manoeuvre.
    pub speed: f64,
    pub revolutions: f64,
    /// Number of cells for which the rudder is amidships in a pull-out.
    pub pull_out: usize,
}

impl ManoeuvreData<'_> {
    pub(crate) fn classify_manoeuvre(&self) -> SegmentKind {
        if self.is_stop() {
            return SegmentKind::Stop;
        }
        match self.holds.len() {
            0 => SegmentKind::SpeedChange,
            holds if holds >= KINDS.zigzag => SegmentKind::Zigzag,
            _ => self.classify_turn(),
        }
    }

    fn classify_turn(&self) -> SegmentKind {
        let turned = heading_range(self.cells);
        if turned > KINDS.course_rad && self.is_pull_out() {
            SegmentKind::PullOut
        } else if turned >= KINDS.turn_rad {
            SegmentKind::Turn
        } else if turned >= KINDS.course_rad {
            SegmentKind::CourseChange
        } else {
            SegmentKind::RudderMovement
        }
    }

    /// Returns true if the propeller is stopped or reversed, and most of the speed is lost.
    fn is_stop(&self) -> bool {
        let slowest = self.cells.iter().map(|cell| cell.speed).fold(f64::INFINITY, f64::min);
        // Relative to the sign of the revolutions before, so that reversed propellers count as
        // negative.
        let least = self.cells.iter().map(|cell| cell.revolutions * self.revolutions.signum());
        let least = least.fold(f64::INFINITY, f64::min);
        slowest < KINDS.stopped * self.speed && least < 0.1 * self.revolutions.abs()
    }

    /// Returns true if the ship continues to turn to the side of the rudder while that is
    /// amidships.
    fn is_pull_out(&self) -> bool {
        let Some(hold) = self.holds.first() else { return false };
        let side = if hold.to_starboard { 1.0 } else { -1.0 };
        let turns_on = |cell: &&LogCell| {
            (cell.rudder - self.steady.rudder).abs() <= self.rudder_limit
                && side * (cell.yaw - self.steady.yaw) > self.yaw_limit
        };
        // The first cell is skipped: the rudder moves to amidships in it.
        let after = self.cells[hold.to..].iter().skip(1).take_while(turns_on).count();
        after >= self.pull_out
    }
}
