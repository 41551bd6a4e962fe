//! Detection of the cells in which controls move and the ship responds.

use std::ops::Range;

use crate::segmentation::cells::LogCells;
use crate::segmentation::level::SteadyLevels;
use crate::segmentation::thresholds::SegmentThresholds;

/// Classification of single cells.
pub(crate) struct CellActivity<'a> {
    cells: &'a LogCells,
    levels: &'a SteadyLevels,
    limits: &'a SegmentThresholds,
    /// Number of cells in which the ship travels its length.
    lag: usize,
}

impl<'a> CellActivity<'a> {
    pub(crate) fn new(cells: &'a LogCells, levels: &'a SteadyLevels) -> Self {
        Self { cells, levels, limits: &cells.limits, lag: cells.cell_count(1.0) }
    }

    /// Returns the ranges of cells from the first movement of a control to the last response of the
    /// ship, in order.
    pub(crate) fn find_manoeuvres(&self) -> Vec<Range<usize>> {
        let mut found: Vec<Range<usize>> = Vec::new();
        let apart = self.cells.cell_count(self.limits.join);
        let mut at = 0;
        while at < self.cells.all.len() {
            if !self.is_moved(at) {
                at += 1;
                continue;
            }
            let end = self.response_end(self.moving_end(at));
            // Movements that follow soon after the last response belong to the same manoeuvre.
            match found
                .last_mut()
                .filter(|last| at <= last.end + apart && self.is_whole(last.end, at))
            {
                Some(last) => last.end = end,
                None => found.push(at..end),
            }
            at = end;
        }
        // Last, since joined movements may have a common response.
        found.retain(|range| self.is_answered(range));
        found
    }

    /// Returns the end of the cells in which controls keep moving.
    fn moving_end(&self, from: usize) -> usize {
        let next = |at: &usize| self.cells.follows_directly(*at) && self.is_moved(*at);
        (from + 1..self.cells.all.len()).take_while(next).last().map_or(from + 1, |last| last + 1)
    }

    /// Returns the end of the cells in which the ship still responds.
    fn response_end(&self, from: usize) -> usize {
        let last = (from + self.cells.cell_count(self.limits.follow)).min(self.cells.all.len());
        let next = |at: &usize| self.cells.follows_directly(*at) && self.is_responding(*at);
        (from..last).take_while(next).last().map_or(from, |last| last + 1)
    }

    fn is_whole(&self, from: usize, to: usize) -> bool {
        (from..=to).all(|at| self.cells.follows_directly(at))
    }

    /// Returns the deviation of the rudder from its level beyond which it is moved, rad.
    pub(crate) fn rudder_limit(&self, at: usize) -> f64 {
        (self.limits.controls * self.levels.level_at(at).rudder_scatter).max(self.limits.rudder_rad)
    }

    /// Returns true if the rudder is off its level, or the revolutions have changed.
    fn is_moved(&self, at: usize) -> bool {
        let (cell, steady) = (&self.cells.all[at], self.levels.level_at(at));
        (cell.rudder - steady.rudder).abs() > self.rudder_limit(at) || self.is_throttled(at)
    }

    fn is_throttled(&self, at: usize) -> bool {
        let Some(before) = at.checked_sub(self.lag).filter(|&from| self.is_whole(from + 1, at))
        else {
            return false;
        };
        let (now, then) = (self.cells.all[at].revolutions, self.cells.all[before].revolutions);
        // Relative to the larger of both, so that stopping and starting count alike.
        let least = self.limits.revolutions * now.abs().max(then.abs());
        let scatter = self.limits.controls * self.levels.level_at(at).revolutions_scatter;
        (now - then).abs() > least.max(scatter)
    }

    fn is_responding(&self, at: usize) -> bool {
        self.is_turning(at, self.limits.answer) || self.is_changing_speed(at, self.limits.answer)
    }

    /// Returns true if the yaw rate is off its level by more than the given number of scatters.
    fn is_turning(&self, at: usize, scatters: f64) -> bool {
        let off = self.cells.all[at].yaw - self.levels.level_at(at).yaw;
        off.abs() > self.yaw_limit(at, scatters)
    }

    pub(crate) fn yaw_limit(&self, at: usize, scatters: f64) -> f64 {
        let scatter = scatters * self.levels.level_at(at).yaw_scatter;
        scatter.max(self.limits.yaw / self.cells.scale.time_s)
    }

    fn is_changing_speed(&self, at: usize, scatters: f64) -> bool {
        let Some(before) = at.checked_sub(self.lag) else { return false };
        let change = (self.cells.all[at].speed - self.cells.all[before].speed).abs();
        let scatter = scatters * self.levels.level_at(at).speed_scatter;
        change > scatter.max(self.limits.speed * self.cells.scale.speed_m_s)
    }

    /// Returns true if the ship responded by more than in course keeping: a rudder that is tested
    /// at the quay moves no ship.
    fn is_answered(&self, range: &Range<usize>) -> bool {
        let (k, mut all) = (self.limits.controls, range.clone());
        all.any(|at| self.is_turning(at, k) || self.is_changing_speed(at, k))
    }
}
