//! Segmentation of a log: rows in, segments and steady spans out.

use std::ops::Range;

use crate::segmentation::active::CellActivity;
use crate::segmentation::blocks::LogBlocks;
use crate::segmentation::cells::LogCells;
use crate::segmentation::level::SteadyLevels;
use crate::segmentation::sample::LogSample;
use crate::segmentation::segment::ManoeuvreSegment;
use crate::segmentation::spans::TimeSpan;
use crate::segmentation::thresholds::{SegmentThresholds, THRESHOLDS};

/// Finder of the segments of a log, which takes its rows in order.
#[derive(Debug)]
pub struct SegmentFinder {
    length_m: Option<f64>,
    limits: SegmentThresholds,
    blocks: LogBlocks,
}

/// Result of the segmentation of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentationResult {
    /// Segments in order of time, without overlap.
    pub stretches: Vec<ManoeuvreSegment>,
    /// Spans of steady course keeping between the segments.
    pub steady: Vec<TimeSpan>,
    /// Span from the first row to the last.
    pub whole: TimeSpan,
    /// Number of rows that were used.
    pub rows: u64,
    /// Length of the ship by which time is scaled, m: as given, or from the speed.
    pub length_m: f64,
    /// Median speed under way, m/s.
    pub speed_m_s: f64,
    /// Scatter of the rudder in course keeping, rad.
    pub rudder_scatter_rad: f64,
}

/// Reason for which a log cannot be segmented.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SegmentationError {
    /// There is no row with a rudder angle.
    #[error("no row has a time and a rudder angle")]
    Rudder,
    /// There is no speed.
    #[error("no column of the speed: map `u`, or `speed` over ground")]
    Speed,
    /// There is neither a yaw rate nor a heading.
    #[error("no column of the yaw rate or the heading: map `r` or `psi`")]
    Yaw,
    /// The ship never moves.
    #[error("the ship is never under way")]
    Still,
}

impl SegmentFinder {
    /// Creates a finder for a ship of the given length, m; without one it is estimated from the
    /// speed.
    pub fn new(length_m: Option<f64>) -> Self {
        Self { length_m, limits: THRESHOLDS, blocks: LogBlocks::new() }
    }

    /// Adds the next row.
    #[inline]
    pub fn push(&mut self, sample: &LogSample) {
        self.blocks.push(sample);
    }

    /// Returns the segments, after the last row.
    ///
    /// # Errors
    /// Returns an error if the log lacks a channel that is needed, or the ship never has way.
    pub fn finish(self) -> Result<SegmentationResult, SegmentationError> {
        let blocks = self.blocks.finish_log();
        match blocks.has {
            _ if blocks.rows == 0 => return Err(SegmentationError::Rudder),
            has if !has.speed => return Err(SegmentationError::Speed),
            has if !has.yaw => return Err(SegmentationError::Yaw),
            _ => {}
        }
        // Each step needs the previous one: cells, levels, movements, spans.
        let cells = LogCells::from_blocks(&blocks, self.length_m, self.limits)
            .ok_or(SegmentationError::Still)?;
        let levels = SteadyLevels::from_cells(&cells);
        let activity = CellActivity::new(&cells, &levels);
        let whole = TimeSpan { from_s: blocks.first_s, to_s: blocks.last_s };
        let ranges = activity.find_manoeuvres();
        let spans = segment_spans(&cells, &ranges, whole);
        let stretches = ranges.iter().zip(&spans).map(|(range, &span)| {
            ManoeuvreSegment::from_cells(&cells, &levels, &activity, range, span)
        });
        Ok(SegmentationResult {
            stretches: stretches.collect(),
            steady: TimeSpan::gaps_between(whole, &spans, cells.limits.steady * cells.scale.time_s),
            whole,
            rows: blocks.rows,
            length_m: cells.scale.length_m,
            speed_m_s: cells.scale.speed_m_s,
            rudder_scatter_rad: levels.rudder_scatter(),
        })
    }
}

impl SegmentationResult {
    /// Returns true if the record is a log rather than a trial: much longer, and mostly steady.
    pub fn is_log(&self) -> bool {
        let long = THRESHOLDS.log * self.length_m / self.speed_m_s;
        let moved: f64 = self.stretches.iter().map(|stretch| stretch.span.duration_s()).sum();
        self.whole.duration_s() > long && moved <= THRESHOLDS.most * self.whole.duration_s()
    }

    /// Returns the time in steady course keeping, s.
    pub fn steady_s(&self) -> f64 {
        self.steady.iter().map(TimeSpan::duration_s).sum()
    }
}

/// Returns the spans of the ranges with approach and settling time; where two would overlap, they
/// meet halfway.
fn segment_spans(cells: &LogCells, ranges: &[Range<usize>], whole: TimeSpan) -> Vec<TimeSpan> {
    let time_s = cells.scale.time_s;
    // A movement may begin at the end of the cell before the one in which it is detected.
    let lead_s = cells.limits.lead * time_s + cells.width_s;
    let core =
        |range: &Range<usize>| (cells.all[range.start].from_s, cells.all[range.end - 1].to_s);
    let mut spans: Vec<TimeSpan> = ranges
        .iter()
        .map(core)
        .map(|(from_s, to_s)| TimeSpan {
            from_s: (from_s - lead_s).max(whole.from_s),
            to_s: (to_s + cells.limits.settle * time_s).min(whole.to_s),
        })
        .collect();
    for at in 1..spans.len() {
        if spans[at].from_s < spans[at - 1].to_s {
            let (_, end) = core(&ranges[at - 1]);
            let (start, _) = core(&ranges[at]);
            let middle = 0.5 * (end + start);
            (spans[at - 1].to_s, spans[at].from_s) = (middle, middle);
        }
    }
    spans
}

#[cfg(test)]
#[path = "finder_tests.rs"]
mod tests;
