//! Windows of the weak form and their weights.

use std::ops::Range;

use sistership_model::trial::Trial;

use super::thresholds::WEAK;

/// Length and spacing of the windows of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowSpacing {
    /// Length, s; at least eight sampling intervals are used.
    pub length_s: f64,
    /// Time from one window's start to the next, s; at least a sampling interval.
    pub hop_s: f64,
}

impl WindowSpacing {
    fn window_length(&self, interval_s: f64) -> f64 {
        self.length_s.max(WEAK.least_intervals * interval_s)
    }

    /// The weight of a window's row: its own share of time, since windows that overlap share
    /// information.
    pub(super) fn effective_share(&self, interval_s: f64) -> f64 {
        (self.hop_s.max(interval_s) / (WEAK.equivalent * self.window_length(interval_s))).min(1.0)
    }

    /// The bump functions of a trial, none of which crosses a gap.
    pub(super) fn bumps_over(&self, trial: &Trial) -> Vec<BumpFunction> {
        let interval_s = trial.interval_s();
        let (length, hop) = (self.window_length(interval_s), self.hop_s.max(interval_s));
        trial
            .segments()
            .into_iter()
            .flat_map(|segment| segment_bumps(&trial.t_s, segment, length, hop))
            .collect()
    }
}

/// The bump functions of a part without gaps.
fn segment_bumps(t_s: &[f64], segment: Range<usize>, length: f64, hop: f64) -> Vec<BumpFunction> {
    let (start, end) = (t_s[segment.start], t_s[segment.end - 1]);
    let count = ((end - start - length) / hop + 1e-9).floor();
    let count = if count < 0.0 { 0 } else { count as usize + 1 };
    let mut first = segment.start;
    // Windows start one after the other, so that the search for the first sample continues from the
    // window before.
    let mut one = |k: usize| {
        let from = start + k as f64 * hop;
        first += t_s[first..segment.end].partition_point(|t| *t < from - 1e-9);
        let samples = t_s[first..segment.end].partition_point(|t| *t <= from + length + 1e-9);
        BumpFunction::new(t_s, first..first + samples, from + 0.5 * length, 0.5 * length)
    };
    (0..count).map(&mut one).collect()
}

/// A bump function over the samples of a window: weights that integrate a column with it, and
/// values that integrate a rate of change by parts.
#[derive(Debug, Clone)]
pub(super) struct BumpFunction {
    samples: Range<usize>,
    /// Trapezoidal weights times the bump; they add up to 1.
    weights: Vec<f64>,
    /// The bump itself at the samples, over the same sum.
    bump: Vec<f64>,
}

impl BumpFunction {
    /// The bump `(1 - s^2)^3` of a window about `centre`, `s` being time from the centre in half
    /// widths.
    fn new(t_s: &[f64], samples: Range<usize>, centre: f64, half: f64) -> Self {
        let t = &t_s[samples.clone()];
        let shape = |t: &f64| (1.0 - ((t - centre) / half).powi(2)).max(0.0).powi(3);
        let mut bump: Vec<f64> = t.iter().map(shape).collect();
        let last = t.len().saturating_sub(1);
        // Trapezoidal rule for samples that need not be evenly spaced.
        let width = |k: usize| 0.5 * (t[(k + 1).min(last)] - t[k.saturating_sub(1)]);
        let mut weights: Vec<f64> = bump.iter().enumerate().map(|(k, b)| b * width(k)).collect();
        let total: f64 = weights.iter().sum();
        weights.iter_mut().chain(&mut bump).for_each(|value| *value /= total);
        Self { samples, weights, bump }
    }

    /// Returns the weighted mean of a column of the trial.
    pub fn mean(&self, column: &[f64]) -> f64 {
        dot_product(&self.weights, &column[self.samples.clone()])
    }

    /// Returns the weighted mean of mass times a velocity's rate of change, by parts: `-int v d(b
    /// m)`, summed so that a constant velocity gives exactly zero. The mass is 1 if none is given.
    pub fn mean_rate(&self, mass: Option<&[f64]>, velocity: &[f64]) -> f64 {
        let v = &velocity[self.samples.clone()];
        let weighted =
            |k: usize| self.bump[k] * mass.map_or(1.0, |mass| mass[self.samples.start + k]);
        let mut before = weighted(0);
        let mut sum = 0.0;
        for k in 1..v.len() {
            let here = weighted(k);
            sum -= 0.5 * (v[k] + v[k - 1]) * (here - before);
            before = here;
        }
        // The boundary term, which is zero only if samples fall on the window's ends.
        sum + (before * v[v.len() - 1] - weighted(0) * v[0])
    }
}

/// The sum of products in eight separate sums: a single one would wait for each of its additions.
fn dot_product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_left), (b, b_left)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + a_left.iter().zip(b_left).map(|(a, b)| a * b).sum::<f64>()
}
