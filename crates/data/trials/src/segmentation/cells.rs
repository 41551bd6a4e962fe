//! Cells, the intervals by which a log is judged: about half of the time in which the ship travels
//! its length.

use crate::segmentation::blocks::{LogBlocks, join_blocks};
use crate::segmentation::thresholds::SegmentThresholds;

/// Gravity, m/s2.
const GRAVITY: f64 = 9.81;

/// Means over an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LogCell {
    pub from_s: f64,
    pub to_s: f64,
    pub rudder: f64,
    pub rudder_square: f64,
    pub rudder_low: f64,
    pub rudder_high: f64,
    pub revolutions: f64,
    pub speed: f64,
    pub yaw: f64,
}

/// Log as cells, and the scale of time on which they are based.
#[derive(Debug)]
pub(crate) struct LogCells {
    pub all: Vec<LogCell>,
    /// Length of a cell, s.
    pub width_s: f64,
    pub scale: ShipScale,
    pub limits: SegmentThresholds,
}

/// Length and speed of the ship, and the time in which it travels its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShipScale {
    pub length_m: f64,
    pub speed_m_s: f64,
    pub time_s: f64,
}

impl ShipScale {
    /// Returns the scale of a ship; without a length, that of a ship with the usual Froude number.
    fn from_speed(length_m: Option<f64>, speed_m_s: f64, limits: &SegmentThresholds) -> Self {
        let of_froude = || (speed_m_s / limits.froude).powi(2) / GRAVITY;
        let usual = || of_froude().max(limits.least_length_m);
        let length_m = length_m.unwrap_or_else(usual);
        Self { length_m, speed_m_s, time_s: length_m / speed_m_s }
    }
}

impl LogCells {
    /// Converts blocks to cells; returns `None` if the ship never has way.
    pub(crate) fn from_blocks(
        blocks: &LogBlocks,
        length_m: Option<f64>,
        limits: SegmentThresholds,
    ) -> Option<Self> {
        let scale = ShipScale::from_speed(length_m, speed_under_way(blocks)?, &limits);
        // A cell is a whole number of blocks, so that no block has to be split.
        let times = (limits.cell * scale.time_s / blocks.width_s).floor().clamp(1.0, 1e9);
        let width_s = times * blocks.width_s;
        let cell = |block: crate::segmentation::blocks::LogBlock| {
            let from_s = blocks.first_s + f64::from(block.at) * width_s;
            let to_s = from_s + width_s;
            LogCell {
                from_s,
                to_s,
                rudder: f64::from(block.rudder),
                rudder_square: f64::from(block.rudder_square),
                rudder_low: f64::from(block.rudder_low),
                rudder_high: f64::from(block.rudder_high),
                revolutions: f64::from(block.revolutions),
                speed: f64::from(block.speed),
                // The last cell may end before its interval does.
                yaw: f64::from(block.turned) / width_s.min(blocks.last_s - from_s + 1e-9),
            }
        };
        let all = join_blocks(&blocks.done, times as u32).into_iter().map(cell).collect();
        Some(Self { all, width_s, scale, limits })
    }

    /// Returns the number of cells of `times` times the scale of time.
    pub(crate) fn cell_count(&self, times: f64) -> usize {
        (times * self.scale.time_s / self.width_s).ceil() as usize
    }

    /// Returns true if no cell is missing between a cell and the previous one.
    pub(crate) fn follows_directly(&self, at: usize) -> bool {
        at > 0 && self.all[at].from_s - self.all[at - 1].to_s < 0.5 * self.width_s
    }
}

/// Returns the median speed of the ship under way: faster than a tenth of the 99 % quantile.
fn speed_under_way(blocks: &LogBlocks) -> Option<f64> {
    let speeds = blocks.done.iter().map(|block| f64::from(block.speed).abs());
    let mut speeds: Vec<f64> = speeds.filter(|speed| speed.is_finite()).collect();
    let high = select_quantile(&mut speeds, 0.99)?;
    let mut moving: Vec<f64> = speeds.into_iter().filter(|speed| *speed > 0.1 * high).collect();
    select_quantile(&mut moving, 0.5).filter(|speed| *speed > 0.0)
}

/// Returns the quantile of the values, which are reordered; `None` for no value.
pub(crate) fn select_quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let at = ((values.len() as f64 * share) as usize).min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(at, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segmentation::thresholds::THRESHOLDS;

    #[test]
    fn a_record_of_a_ship_that_lies_still_has_the_scale_of_a_model() {
        let estimated = |speed_m_s| ShipScale::from_speed(None, speed_m_s, &THRESHOLDS).length_m;
        assert_eq!(estimated(0.01), 0.5);
        assert!((estimated(7.0) - 124.9).abs() < 0.1, "by Froude's number");
        assert_eq!(ShipScale::from_speed(Some(0.3), 0.01, &THRESHOLDS).length_m, 0.3);
    }
}
