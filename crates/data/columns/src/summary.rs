//! Summary of the values of a column: range, period, steps.

use std::f64::consts::TAU;

/// Periods at which directions wrap, with the unit that each implies.
const PERIODS: [(f64, &str); 2] = [(360.0, "deg"), (TAU, "rad")];
/// Number of crossings of the mean that a heading in zigzags does not reach.
const SWINGS: usize = 60;
/// Number of blocks whose means show whether a column is held for most of the time.
const UNREST_BLOCKS: usize = 600;
/// Largest number of samples of an average across the wrap.
const AVERAGED: usize = 8;
/// Deviation from the median of the neighbours, in robust standard deviations, above which a value
/// is replaced before columns are compared. The recording itself is not changed.
const SPIKE: f64 = 12.0;

/// Range and shape of the values of a column.
#[derive(Debug, Clone, Default)]
pub(crate) struct ColumnSummary {
    /// Number of finite values.
    pub count: usize,
    /// 99 % quantile of the magnitudes.
    pub largest: f64,
    pub median: f64,
    /// Distance between the 1 % and the 99 % quantile.
    pub spread: f64,
    /// Fraction of values below zero.
    pub negative: f64,
    /// Period at which the values wrap, and its unit.
    pub period: Option<(f64, &'static str)>,
    /// Fraction of steps that do not decrease.
    pub forward: f64,
    /// Median step.
    pub step: f64,
    /// Fraction of steps within 10 % of the median.
    pub regular: f64,
    /// Fraction of steps within 1 % of the median.
    pub steady: f64,
    /// True if the values swing about their mean, as roll does and a heading does not.
    pub swings: bool,
    /// True if the column counts rows.
    pub is_counter: bool,
    /// Fraction of steps that are zero.
    pub still: f64,
    /// Median of the steps between means of short blocks by the largest of them; `None` where
    /// nothing changes. A rudder is held and moved at once: its median step is far smaller.
    pub unrest: Option<f64>,
}

impl ColumnSummary {
    /// Summarises the values of one recording, or of several in sequence: no step is formed across
    /// a break, since clocks restart there.
    pub(crate) fn new(values: &[f64], breaks: &[usize]) -> Self {
        let finite = |value: &f64| value.is_finite();
        let mut sorted: Vec<f64> = values.iter().copied().filter(finite).collect();
        if sorted.is_empty() {
            return Self::default();
        }
        let steps = steps_within(values, breaks);
        let period = find_period(&sorted);
        let first = sorted[0];
        let unrest = block_unrest(&sorted);
        let swings = swings_about_mean(&sorted);
        sorted.sort_by(f64::total_cmp);
        let mut summary = Self {
            count: sorted.len(),
            median: sorted_quantile(&sorted, 0.5),
            spread: sorted_quantile(&sorted, 0.99) - sorted_quantile(&sorted, 0.01),
            negative: fraction_where(&sorted, |value| value < 0.0),
            period,
            swings: swings && period.is_none(),
            unrest,
            ..Self::default()
        };
        let mut magnitudes: Vec<f64> = sorted.iter().map(|value| value.abs()).collect();
        magnitudes.sort_by(f64::total_cmp);
        summary.largest = sorted_quantile(&magnitudes, 0.99);
        summary.summarise_steps(steps, first);
        summary
    }

    fn summarise_steps(&mut self, mut steps: Vec<f64>, first: f64) {
        if steps.is_empty() {
            return;
        }
        // Row numbers increase by exactly one.
        let counts = steps.iter().all(|step| *step == 1.0);
        self.is_counter = counts && (first == 0.0 || first == 1.0 || first.fract() == 0.0);
        self.forward = fraction_where(&steps, |step| step >= 0.0);
        self.still = fraction_where(&steps, |step| step == 0.0);
        steps.sort_by(f64::total_cmp);
        let step = sorted_quantile(&steps, 0.5);
        self.step = step;
        self.regular = fraction_where(&steps, |one| (one - step).abs() <= 0.1 * step.abs());
        self.steady = fraction_where(&steps, |one| (one - step).abs() <= 0.01 * step.abs());
    }

    /// Returns true if the values increase as a clock does.
    pub(crate) fn is_clock(&self) -> bool {
        // One step in fifty may be out of order, as a fault of the file.
        self.count > 1 && self.forward > 0.98 && self.step > 0.0 && self.still < 0.9
    }
}

/// Returns the median of the steps between means of [`UNREST_BLOCKS`] blocks by their 98 % quantile.
fn block_unrest(values: &[f64]) -> Option<f64> {
    let rows = (values.len() / UNREST_BLOCKS).max(2);
    let means: Vec<f64> =
        values.chunks_exact(rows).map(|block| block.iter().sum::<f64>() / rows as f64).collect();
    let mut steps: Vec<f64> = means.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    let largest = sorted_quantile(&steps, 0.98);
    (largest > 0.0).then(|| sorted_quantile(&steps, 0.5) / largest)
}

/// Returns the steps between consecutive finite values, none across a break.
fn steps_within(values: &[f64], breaks: &[usize]) -> Vec<f64> {
    let ends = breaks.iter().copied().chain([values.len()]);
    let mut steps = Vec::with_capacity(values.len());
    let mut from = 0;
    for end in ends.map(|end| end.min(values.len())) {
        let part = values.get(from..end).unwrap_or_default();
        let part: Vec<f64> = part.iter().copied().filter(|value| value.is_finite()).collect();
        steps.extend(part.windows(2).map(|pair| pair[1] - pair[0]));
        from = end;
    }
    steps
}

/// Nearest-rank quantile of sorted values; 0 for none.
pub(crate) fn sorted_quantile(sorted: &[f64], part: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((last as f64 * part).round() as usize).copied().unwrap_or(0.0)
}

pub(crate) fn fraction_where(values: &[f64], holds: impl Fn(f64) -> bool) -> f64 {
    let count = values.iter().filter(|value| holds(**value)).count();
    count as f64 / values.len().max(1) as f64
}

/// Returns true if the mean is crossed more often than a heading crosses it in any manoeuvre.
fn swings_about_mean(values: &[f64]) -> bool {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let (low, high) = values.iter().fold((0.0_f64, 0.0_f64), |(low, high), value| {
        (low.min(value - mean), high.max(value - mean))
    });
    // Noise about the mean is no swing: a crossing must pass a tenth of the range on either side.
    let (mut side, mut crossings) = (0.0, 0);
    for value in values.iter().map(|value| value - mean) {
        let now = if value > 0.1 * high {
            1.0
        } else if value < 0.1 * low {
            -1.0
        } else {
            side
        };
        crossings += usize::from(now * side < 0.0);
        side = now;
    }
    crossings > SWINGS
}

/// Returns the period of a direction that wraps: the values keep within one period, fill most of
/// it, and jump by it.
fn find_period(values: &[f64]) -> Option<(f64, &'static str)> {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
    PERIODS.into_iter().find(|(period, _)| {
        let within = high - low <= 1.005 * period && high - low > 0.8 * period;
        let bounds = low >= -0.505 * period && high <= 1.005 * period;
        let jumps = values.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 0.7 * period);
        let near = within && bounds && jumps.count() > 0;
        // Directions are written either from -180 to 180 or from 0 to 360 degrees.
        near && (low < -0.3 * period || low >= -0.01 * period)
    })
}

/// Returns the values as a continuous signal: directions unwrapped, gaps held, spikes replaced.
pub(crate) fn continuous_signal(values: &[f64], summary: &ColumnSummary) -> Vec<f64> {
    let period = summary.period.map(|(period, _)| period);
    let mut values: Vec<f64> = match period {
        Some(period) => unwrap_direction(values, period),
        None => values.to_vec(),
    };
    hold_gaps(&mut values);
    if period.is_none() {
        replace_spikes(&mut values);
    }
    values
}

/// Returns a direction without jumps; averages across the wrap become gaps.
fn unwrap_direction(values: &[f64], period: f64) -> Vec<f64> {
    let wrap = |step: f64| step - (step / period).round() * period;
    let mut out = vec![f64::NAN; values.len()];
    let Some(start) = values.iter().position(|value| value.is_finite()) else { return out };
    let (mut before, mut sum) = (values[start], values[start]);
    out[start] = sum;
    let mut k = start + 1;
    while k < values.len() {
        // If the next value is far, it may be an average across the wrap: look ahead for a value
        // near the last one, and skip those between; without one the step is real.
        let far = |at: usize| {
            let step = wrap(values[at] - before).abs();
            step > 0.12 * period || step.is_nan()
        };
        let end = values.len().min(k + AVERAGED);
        let at = if far(k) { (k..end).find(|&at| !far(at)).unwrap_or(k) } else { k };
        if values[at].is_finite() {
            sum += wrap(values[at] - before);
            (before, out[at]) = (values[at], sum);
        }
        k = at + 1;
    }
    out
}

fn hold_gaps(values: &mut [f64]) {
    let mut last = values.iter().copied().find(|value| value.is_finite()).unwrap_or(0.0);
    for value in values {
        if value.is_finite() {
            last = *value;
        }
        *value = last;
    }
}

/// Replaces values far from the median of five neighbours by that median.
fn replace_spikes(values: &mut [f64]) {
    let n = values.len();
    if n < 20 {
        return;
    }
    let around = |k: usize| {
        let mut near = [values[k - 2], values[k - 1], values[k], values[k + 1], values[k + 2]];
        near.sort_by(f64::total_cmp);
        near[2]
    };
    let medians: Vec<f64> = (2..n - 2).map(around).collect();
    let mut apart: Vec<f64> = (2..n - 2).map(|k| (values[k] - medians[k - 2]).abs()).collect();
    apart.sort_by(f64::total_cmp);
    // A column that is mostly constant has no scatter of its own: then its largest moves count.
    let scatter = (1.4826 * sorted_quantile(&apart, 0.5)).max(sorted_quantile(&apart, 0.99));
    if scatter <= 0.0 {
        return;
    }
    for k in 2..n - 2 {
        if (values[k] - medians[k - 2]).abs() > SPIKE * scatter {
            values[k] = medians[k - 2];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_clocks_and_counters_are_seen() {
        let heading: Vec<f64> = (0..500).map(|k| f64::from(k) * 3.0 % 360.0).collect();
        let summary = ColumnSummary::new(&heading, &[]);
        assert_eq!(summary.period.map(|(_, unit)| unit), Some("deg"));
        assert!((continuous_signal(&heading, &summary)[499] - 1497.0).abs() < 1e-9);
        let clock: Vec<f64> = (0..500).map(|k| 2.7e6 + 100.0 * f64::from(k)).collect();
        assert!(
            ColumnSummary::new(&clock, &[]).is_clock()
                && !ColumnSummary::new(&clock, &[]).is_counter
        );
        assert!(ColumnSummary::new(&(0..9).map(f64::from).collect::<Vec<_>>(), &[]).is_counter);
        assert!(ColumnSummary::new(&heading[..100], &[]).period.is_none());
    }

    #[test]
    fn averages_across_the_period_do_not_turn_a_direction() {
        let mut heading: Vec<f64> = (0..200).map(|k| (350.0 + f64::from(k)) % 360.0).collect();
        (heading[10], heading[11]) = (180.0, 120.0);
        let mut long = heading.clone();
        long.extend((0..300).map(|k| (190.0 + f64::from(k)) % 360.0));
        let signal = continuous_signal(&long, &ColumnSummary::new(&long, &[]));
        assert!((signal[150] - 500.0).abs() < 1e-9, "{}", signal[150]);
    }

    #[test]
    fn a_clock_that_begins_anew_in_each_file_is_a_clock() {
        let clock = [0.0, 1.0, 0.0, 1.0];
        assert!(!ColumnSummary::new(&clock, &[]).is_clock());
        assert!(ColumnSummary::new(&clock, &[2]).is_clock());
    }
}
