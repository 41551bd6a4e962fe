//! Means over short intervals, whose number is bounded: when there are too many, neighbours are
//! joined and the intervals become twice as long.

use crate::segmentation::sample::LogSample;

/// Largest number of intervals: 20 MB, and 2 s each in a log of eleven days.
const MOST: usize = 1 << 19;
/// Initial length of the intervals, s: a model of 3 m travels its length in 4 s.
const FIRST_S: f64 = 0.25;

/// Summary of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LogBlock {
    /// Number of the interval, counted from the first row.
    pub at: u32,
    pub rows: u32,
    /// Means of the rows.
    pub rudder: f32,
    pub rudder_square: f32,
    pub revolutions: f32,
    pub speed: f32,
    /// Lowest and highest rudder angle.
    pub rudder_low: f32,
    pub rudder_high: f32,
    /// Change of heading, rad.
    pub turned: f32,
}

/// Sums over the current interval.
#[derive(Debug, Clone, Copy, Default)]
struct BlockSums {
    rows: u32,
    rudder: f64,
    rudder_square: f64,
    revolutions: f64,
    speed: f64,
    low: f64,
    high: f64,
    turned: f64,
}

/// Blocks of a log that is being read.
#[derive(Debug)]
pub(crate) struct LogBlocks {
    pub done: Vec<LogBlock>,
    pub width_s: f64,
    pub first_s: f64,
    pub last_s: f64,
    pub rows: u64,
    /// Channels that any row has had.
    pub has: PresentChannels,
    end_s: f64,
    /// Time between the two previous rows, s.
    step_s: f64,
    open: BlockSums,
    /// Last readings: a slower instrument holds its reading until the next.
    revolutions: f64,
    speed: f64,
    heading: f64,
}

/// Channels that a log has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct PresentChannels {
    pub revolutions: bool,
    pub yaw: bool,
    pub speed: bool,
}

impl LogBlocks {
    pub(crate) fn new() -> Self {
        Self {
            done: Vec::new(),
            width_s: FIRST_S,
            first_s: f64::NAN,
            last_s: f64::NEG_INFINITY,
            rows: 0,
            has: PresentChannels::default(),
            end_s: f64::NEG_INFINITY,
            step_s: 0.0,
            open: BlockSums::default(),
            revolutions: f64::NAN,
            speed: f64::NAN,
            heading: f64::NAN,
        }
    }

    /// Adds a row; one without a rudder angle, or not later than the last, is ignored.
    #[inline]
    pub(crate) fn push(&mut self, sample: &LogSample) {
        let t_s = sample.t_s;
        if !(sample.rudder_rad.is_finite() && t_s > self.last_s && t_s.is_finite()) {
            return;
        }
        if t_s >= self.end_s {
            self.open_block(t_s);
        }
        self.hold_readings(sample);
        let (turned, rudder) = (self.heading_change(sample), sample.rudder_rad);
        let open = &mut self.open;
        open.rows += 1;
        open.rudder += rudder;
        open.rudder_square += rudder * rudder;
        open.revolutions += self.revolutions;
        open.speed += self.speed;
        open.low = open.low.min(rudder);
        open.high = open.high.max(rudder);
        open.turned += turned;
        self.rows += 1;
        self.step_s = if self.rows == 1 { 0.0 } else { t_s - self.last_s };
        self.last_s = t_s;
    }

    #[inline]
    fn hold_readings(&mut self, sample: &LogSample) {
        if sample.revolutions_rps.is_finite() {
            self.revolutions = sample.revolutions_rps;
            self.has.revolutions = true;
        }
        if sample.speed_m_s.is_finite() {
            self.speed = sample.speed_m_s;
            self.has.speed = true;
        }
    }

    /// Returns the change of heading since the previous row: by the yaw rate where it is measured,
    /// otherwise along the shorter way.
    #[inline]
    fn heading_change(&mut self, sample: &LogSample) -> f64 {
        let rate = sample.yaw_rate_rad_s;
        if rate.is_finite() {
            self.has.yaw = true;
            // The motion in a gap is not known: the rate counts for two sampling intervals at most.
            return rate * (sample.t_s - self.last_s).min(2.0 * self.step_s);
        }
        if !sample.heading_rad.is_finite() {
            return 0.0;
        }
        self.has.yaw = true;
        let before = std::mem::replace(&mut self.heading, sample.heading_rad);
        let change = sample.heading_rad - before;
        if change.abs() <= std::f64::consts::PI {
            return change;
        }
        // The first heading has no predecessor: the change is NaN, and counts as none.
        let turns = (change / std::f64::consts::TAU).round();
        if turns.is_finite() { change - turns * std::f64::consts::TAU } else { 0.0 }
    }

    /// Closes the current interval and opens that of a time.
    #[cold]
    fn open_block(&mut self, t_s: f64) {
        if self.rows == 0 {
            self.first_s = t_s;
        }
        self.close_block();
        // Doubling the width at least halves the blocks of a log without gaps, so that memory stays
        // bounded.
        while self.done.len() >= MOST || self.block_number(t_s) >= f64::from(u32::MAX) {
            self.double_width();
        }
        self.end_s = self.first_s + (self.block_number(t_s) + 1.0) * self.width_s;
        self.open =
            BlockSums { low: f64::INFINITY, high: f64::NEG_INFINITY, ..BlockSums::default() };
    }

    fn block_number(&self, t_s: f64) -> f64 {
        ((t_s - self.first_s) / self.width_s).floor()
    }

    fn close_block(&mut self) {
        let BlockSums { rows, rudder, rudder_square, revolutions, speed, low, high, turned } =
            self.open;
        if rows == 0 {
            return;
        }
        let mean = |sum: f64| (sum / f64::from(rows)) as f32;
        self.done.push(LogBlock {
            at: self.block_number(self.last_s) as u32,
            rows,
            rudder: mean(rudder),
            rudder_square: mean(rudder_square),
            revolutions: mean(revolutions),
            speed: mean(speed),
            rudder_low: low as f32,
            rudder_high: high as f32,
            turned: turned as f32,
        });
        self.open.rows = 0;
    }

    fn double_width(&mut self) {
        self.width_s *= 2.0;
        self.done = join_blocks(&self.done, 2);
    }

    /// Returns the blocks of the whole log.
    pub(crate) fn finish_log(mut self) -> Self {
        self.close_block();
        self
    }
}

/// Returns blocks that are `times` as long.
pub(crate) fn join_blocks(blocks: &[LogBlock], times: u32) -> Vec<LogBlock> {
    let mut out: Vec<LogBlock> = Vec::with_capacity(blocks.len() / times as usize + 1);
    for block in blocks {
        let block = LogBlock { at: block.at / times, ..*block };
        match out.last_mut().filter(|last| last.at == block.at) {
            Some(last) => *last = last.merge_with(&block),
            None => out.push(block),
        }
    }
    out
}

impl LogBlock {
    fn merge_with(&self, other: &Self) -> Self {
        // Means are weighted by the number of rows.
        let (own, others) = (self.rows as f32, other.rows as f32);
        // A channel that one of the blocks lacks (NaN) has the mean of the other.
        let mean = |a: f32, b: f32| match (a.is_nan(), b.is_nan()) {
            (false, true) => a,
            (true, false) => b,
            _ => (a * own + b * others) / (own + others),
        };
        Self {
            at: self.at,
            rows: self.rows + other.rows,
            rudder: mean(self.rudder, other.rudder),
            rudder_square: mean(self.rudder_square, other.rudder_square),
            revolutions: mean(self.revolutions, other.revolutions),
            speed: mean(self.speed, other.speed),
            rudder_low: self.rudder_low.min(other.rudder_low),
            rudder_high: self.rudder_high.max(other.rudder_high),
            turned: self.turned + other.turned,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(t_s: f64) -> LogSample {
        LogSample {
            t_s,
            rudder_rad: if t_s < 50.0 { 0.1 } else { -0.1 },
            revolutions_rps: if t_s < 10.0 { 2.0 } else { f64::NAN },
            yaw_rate_rad_s: f64::NAN,
            heading_rad: (0.1 * t_s) % std::f64::consts::TAU,
            speed_m_s: 5.0,
        }
    }

    #[test]
    fn intervals_have_means_and_readings_hold() {
        let mut blocks = LogBlocks::new();
        (0..1000).for_each(|k| blocks.push(&sample(0.1 * f64::from(k))));
        blocks.push(&sample(3.0));
        let blocks = blocks.finish_log();
        let all = join_blocks(&blocks.done, 400);
        assert_eq!((all.len(), all[0].rows, blocks.rows), (1, 1000, 1000));
        let whole = all[0];
        assert!((whole.turned - 9.99).abs() < 1e-3, "{whole:?}");
        assert!(whole.rudder.abs() < 1e-6 && (whole.rudder_square - 0.01).abs() < 1e-6);
        assert_eq!((whole.revolutions, whole.rudder_low, whole.rudder_high), (2.0, -0.1, 0.1));
    }

    #[test]
    fn a_long_log_takes_no_more_memory() {
        let mut blocks = LogBlocks::new();
        let rows = 3 * MOST as u32;
        (0..rows).for_each(|k| blocks.push(&sample(f64::from(k))));
        let blocks = blocks.finish_log();
        assert!(blocks.done.len() <= MOST && blocks.width_s > FIRST_S);
        assert_eq!(blocks.done.iter().map(|block| block.rows).sum::<u32>(), rows);
        let turned: f64 = blocks.done.iter().map(|block| f64::from(block.turned)).sum();
        assert!((turned - 0.1 * f64::from(rows - 1)).abs() < 1.0, "{turned}");
    }
}
