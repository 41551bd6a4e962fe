//! Steady level and scatter of rudder and yaw rate in course keeping, in moving windows of the log
//! itself, since weather and load change.

use crate::segmentation::cells::{LogCell, LogCells, select_quantile};
use crate::segmentation::thresholds::SegmentThresholds;

/// Level and scatter of rudder, yaw rate, revolutions and speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SteadyLevel {
    pub rudder: f64,
    pub rudder_scatter: f64,
    pub yaw: f64,
    pub yaw_scatter: f64,
    /// Scatter of the change of revolutions, and of speed, within the time of one length travelled.
    pub revolutions_scatter: f64,
    pub speed_scatter: f64,
}

/// Steady level at each cell.
#[derive(Debug)]
pub(crate) struct SteadyLevels {
    each: Vec<SteadyLevel>,
    step: usize,
}

impl SteadyLevels {
    pub(crate) fn from_cells(cells: &LogCells) -> Self {
        // Windows of two steps overlap by half, and the levels of a step come from the window about
        // it.
        let step = (cells.cell_count(cells.limits.level) / 2).max(1);
        let starts = (0..cells.all.len()).step_by(step);
        let own: Vec<SteadyLevel> = starts
            .map(|start| {
                let from = start.saturating_sub(step / 2);
                let to = (start + step + step / 2).min(cells.all.len());
                window_level(&cells.all[from..to], cells.cell_count(1.0), &cells.limits)
            })
            .collect();
        Self { each: (0..own.len()).map(|k| with_neighbour_scatter(&own, k)).collect(), step }
    }

    pub(crate) fn level_at(&self, cell: usize) -> SteadyLevel {
        self.each[(cell / self.step).min(self.each.len() - 1)]
    }

    /// Returns the scatter of the rudder in most of the log.
    pub(crate) fn rudder_scatter(&self) -> f64 {
        let mut scatters: Vec<f64> = self.each.iter().map(|steady| steady.rudder_scatter).collect();
        select_quantile(&mut scatters, 0.5).unwrap_or(0.0)
    }
}

/// Returns the level of a window with the largest scatter of its neighbours: where the sea rises,
/// half of a window is still calm.
fn with_neighbour_scatter(own: &[SteadyLevel], at: usize) -> SteadyLevel {
    let near = &own[at.saturating_sub(1)..(at + 2).min(own.len())];
    let most = |of: fn(&SteadyLevel) -> f64| near.iter().map(of).fold(0.0, f64::max);
    SteadyLevel {
        rudder_scatter: most(|steady| steady.rudder_scatter),
        yaw_scatter: most(|steady| steady.yaw_scatter),
        revolutions_scatter: most(|steady| steady.revolutions_scatter),
        speed_scatter: most(|steady| steady.speed_scatter),
        ..own[at]
    }
}

fn window_level(cells: &[LogCell], lag: usize, limits: &SegmentThresholds) -> SteadyLevel {
    let level = |values: &mut dyn Iterator<Item = f64>| median_and_scatter(values, limits);
    let (rudder, rudder_scatter) = level(&mut cells.iter().map(|cell| cell.rudder));
    let (yaw, yaw_scatter) = level(&mut cells.iter().map(|cell| cell.yaw));
    let changes = |of: fn(&LogCell) -> f64| {
        let pairs = cells.iter().zip(cells.iter().skip(lag));
        level(&mut pairs.map(|(before, after)| of(after) - of(before))).1
    };
    SteadyLevel {
        rudder,
        rudder_scatter,
        yaw,
        yaw_scatter,
        revolutions_scatter: changes(|cell| cell.revolutions),
        speed_scatter: changes(|cell| cell.speed),
    }
}

/// Returns the median, and the standard deviation of the normal distribution whose inner part is
/// equally wide.
fn median_and_scatter(
    values: &mut dyn Iterator<Item = f64>,
    limits: &SegmentThresholds,
) -> (f64, f64) {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    let middle = select_quantile(&mut values, 0.5).unwrap_or(0.0);
    values.iter_mut().for_each(|value| *value = (*value - middle).abs());
    let inner = select_quantile(&mut values, limits.share).unwrap_or(0.0);
    (middle, inner / limits.normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segmentation::thresholds::THRESHOLDS;
    use rand::{RngExt, SeedableRng};
    use rand_distr::StandardNormal;

    #[test]
    fn scatter_is_a_standard_deviation_and_manoeuvres_hardly_count() {
        let mut rng = rand_chacha::ChaCha12Rng::seed_from_u64(1);
        let mut values: Vec<f64> =
            (0..4000).map(|_| 0.1 + 0.5 * rng.sample::<f64, _>(StandardNormal)).collect();
        let (middle, scatter) = median_and_scatter(&mut values.iter().copied(), &THRESHOLDS);
        assert!((middle - 0.1).abs() < 0.05 && (scatter - 0.5).abs() < 0.06, "{middle} {scatter}");
        values.iter_mut().step_by(2).for_each(|value| *value = value.signum() * 20.0);
        let (_, scatter) = median_and_scatter(&mut values.into_iter(), &THRESHOLDS);
        assert!(scatter < 2.0, "{scatter}");
    }
}
