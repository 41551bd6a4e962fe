//! Excitation of a segment, on which the information for a fit depends.

use serde::Serialize;

use crate::segmentation::cells::LogCell;
use crate::segmentation::level::SteadyLevel;

/// Measures of the excitation of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Excitation {
    /// Root mean square of the rudder about its steady level, deg.
    pub rudder_rms_deg: f64,
    /// Lowest rudder angle, deg.
    pub rudder_low_deg: f64,
    /// Highest rudder angle, deg.
    pub rudder_high_deg: f64,
    /// Number of times that the rudder was moved to the other side.
    pub rudder_reversals: usize,
    /// Root mean square of the yaw rate, deg/s.
    pub yaw_rate_rms_deg_s: f64,
    /// Highest yaw rate to either side, deg/s.
    pub yaw_rate_max_deg_s: f64,
    /// Range of the heading, deg.
    pub heading_range_deg: f64,
    /// Range of the speed, divided by the usual speed of the ship, dimensionless.
    pub speed_range: f64,
}

impl Excitation {
    /// Computes the excitation of cells about the steady level.
    pub(crate) fn from_cells(
        cells: &[LogCell],
        steady: &SteadyLevel,
        reversals: usize,
        speed_m_s: f64,
    ) -> Self {
        let count = cells.len().max(1) as f64;
        let mean = |of: &dyn Fn(&LogCell) -> f64| cells.iter().map(of).sum::<f64>() / count;
        let level = steady.rudder;
        // Mean of (rudder - level)^2 from the means of rudder and rudder^2; rounding may make it
        // negative.
        let square =
            mean(&|cell| cell.rudder_square - 2.0 * level * cell.rudder + level * level).max(0.0);
        let yaw = mean(&|cell| cell.yaw * cell.yaw);
        let fastest = cells.iter().map(|cell| cell.yaw.abs()).fold(0.0, f64::max);
        let (slow, fast) = value_bounds(cells.iter().map(|cell| cell.speed));
        Self {
            rudder_rms_deg: square.sqrt().to_degrees(),
            rudder_low_deg: value_bounds(cells.iter().map(|cell| cell.rudder_low)).0.to_degrees(),
            rudder_high_deg: value_bounds(cells.iter().map(|cell| cell.rudder_high)).1.to_degrees(),
            rudder_reversals: reversals,
            yaw_rate_rms_deg_s: yaw.sqrt().to_degrees(),
            yaw_rate_max_deg_s: fastest.to_degrees(),
            heading_range_deg: heading_range(cells).to_degrees(),
            speed_range: (fast - slow) / speed_m_s,
        }
    }
}

/// Returns the lowest and the highest value.
fn value_bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Returns the range of the heading, rad, relative to that at the start.
pub(crate) fn heading_range(cells: &[LogCell]) -> f64 {
    let mut psi = 0.0;
    let (low, high) = value_bounds(cells.iter().map(|cell| {
        psi += cell.yaw * (cell.to_s - cell.from_s);
        psi
    }));
    if cells.is_empty() { 0.0 } else { high.max(0.0) - low.min(0.0) }
}
