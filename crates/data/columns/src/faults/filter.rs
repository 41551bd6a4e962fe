//! Robust filter of a channel: level and slope, from both directions.
//!
//! Where the rate of the channel is known, its integral is subtracted first. A value is rejected if
//! it lies further from its prediction than eight times the 80 % quantile of all such distances,
//! and it is a fault if both the forward and the backward pass reject it, so that a sudden manoeuvre
//! is not a fault. The limit is ten standard deviations of normal noise; of Laplace noise, whose
//! tails are heavy, 3 in 10^6 samples are beyond.

use std::f64::consts::{PI, TAU};
use std::iter::zip;

use super::filtered_channel::FilteredChannel;
use super::runs::flagged_runs;

/// Multiple of the 80 % quantile of innovations beyond which a sample is rejected.
const GATE: f64 = 8.0;
/// Gains of the level and of the slope.
const LEVEL: f64 = 0.7;
const SLOPE: f64 = 0.2;
/// Number of consecutive rejected samples after which the filter restarts: a longer deviation is
/// not a fault.
const MAX_REJECTED: usize = 60;
/// Number of steps from which the initial slope is taken.
const SLOPE_STEPS: usize = 15;
/// Widening of the gate with each rejected sample, as a fraction of it: of a channel that may change
/// suddenly, and of a position, which cannot. The slope of the latter has an error of a quarter of
/// the noise to a step.
const GROWTH: f64 = 1.0;
const POSITION_GROWTH: f64 = 0.1;
/// Fraction of equal neighbours above which a recorder repeats readings until there is a new one.
const HELD: f64 = 0.2;
/// Largest step into or out of a run of deviating samples, in median steps of the samples around, of
/// a motion that is fast and not a fault.
const SMOOTH: f64 = 3.0;
/// Number of samples on each side of a run whose steps are compared.
const AROUND: usize = 4;

/// Channel less the integral of its rate, and the largest innovation of a sample that is accepted.
pub(super) struct RobustFilter {
    pub values: Vec<f64>,
    pub gate: f64,
    /// True if the integral of the rate is subtracted.
    pub is_rated: bool,
    /// Samples that repeat a reading because there is no new one; they have no value.
    repeated: Vec<usize>,
    is_direction: bool,
    growth: f64,
}

impl RobustFilter {
    /// Returns the filter with the rate of the channel or without it, whichever predicts better.
    pub(super) fn best_prediction(t_s: &[f64], channel: &FilteredChannel) -> Self {
        let rated = channel.rate.map(|_| Self::new(t_s, channel));
        match rated {
            // Heading and yaw rate may have been recorded with different delays.
            Some(rated) if rated.gate > channel.least => {
                let alone = Self::new(t_s, &FilteredChannel { rate: None, ..*channel });
                if rated.gate <= alone.gate { rated } else { alone }
            }
            Some(rated) => rated,
            None => Self::new(t_s, channel),
        }
    }

    fn new(t_s: &[f64], channel: &FilteredChannel) -> Self {
        let mut values = match channel.rate {
            Some(rate) => subtract_rate(t_s, channel.values, rate),
            None => channel.values.to_vec(),
        };
        let repeated = held_samples(channel.values);
        repeated.iter().for_each(|&k| values[k] = f64::NAN);
        let is_rated = channel.rate.is_some();
        let growth = if channel.is_position { POSITION_GROWTH } else { GROWTH };
        let (is_direction, gate) = (channel.is_direction, f64::INFINITY);
        let mut filter = Self { values, gate, is_rated, repeated, is_direction, growth };
        // The first pass accepts everything (infinite gate) and gives the distances that set the
        // gate.
        let forward = filter.filter_samples(t_s, 0..t_s.len());
        let distances: Vec<f64> = forward.into_iter().flatten().map(f64::abs).collect();
        filter.gate = upper_quantile(distances)
            .map_or(f64::INFINITY, |quantile| (GATE * quantile).max(channel.least));
        filter
    }

    /// Returns the innovations of the samples visited in the given order; `None` for a gap.
    fn filter_samples(&self, t_s: &[f64], order: impl Iterator<Item = usize>) -> Vec<Option<f64>> {
        let order: Vec<usize> = order.collect();
        let mut innovations = vec![None; self.values.len()];
        let mut state: Option<(f64, f64, f64)> = None;
        let mut lost = 0_usize;
        for (at, &k) in order.iter().enumerate() {
            let value = self.values[k];
            if !value.is_finite() || !t_s[k].is_finite() {
                continue;
            }
            let Some((level, slope, last)) = state.filter(|_| lost < MAX_REJECTED) else {
                state = Some((value, self.median_slope(t_s, &order[at..]), t_s[k]));
                lost = 0;
                continue;
            };
            // Alpha-beta filter: predict with the slope, then correct level and slope by fixed
            // gains. The gate widens with each rejected sample, as the prediction grows less
            // certain.
            let step = t_s[k] - last;
            let predicted = level + slope * step;
            let innovation = self.wrap_change(value - predicted);
            let widened = 1.0 + self.growth * lost as f64;
            innovations[k] = Some(innovation / widened);
            if innovation.abs() > self.gate * widened {
                lost += 1;
                continue;
            }
            lost = 0;
            let turned = if step == 0.0 { 0.0 } else { SLOPE * innovation / step };
            state = Some((predicted + LEVEL * innovation, slope + turned, t_s[k]));
        }
        innovations
    }

    /// Returns the median slope of the next samples, which a fault among them does not change.
    fn median_slope(&self, t_s: &[f64], next: &[usize]) -> f64 {
        let pairs = next.windows(2).take(SLOPE_STEPS);
        let slopes = pairs.map(|pair| {
            let change = self.wrap_change(self.values[pair[1]] - self.values[pair[0]]);
            change / (t_s[pair[1]] - t_s[pair[0]])
        });
        let mut slopes: Vec<f64> = slopes.filter(|slope| slope.is_finite()).collect();
        slopes.sort_by(f64::total_cmp);
        slopes.get(slopes.len() / 2).copied().unwrap_or(0.0)
    }

    /// Brings the change of a direction into -pi to pi; other channels stay as they are.
    pub(super) fn wrap_change(&self, change: f64) -> f64 {
        if self.is_direction { change - ((change + PI) / TAU).floor() * TAU } else { change }
    }

    /// Flags the samples that both passes reject and into or out of which the channel leaps.
    pub(super) fn rejected_samples(&self, t_s: &[f64]) -> Vec<bool> {
        let beyond = |innovation: Option<f64>| innovation.is_some_and(|one| one.abs() > self.gate);
        let forward = self.filter_samples(t_s, 0..t_s.len());
        let backward = self.filter_samples(t_s, (0..t_s.len()).rev());
        let mut rejected: Vec<bool> =
            zip(forward, backward).map(|(a, b)| beyond(a) && beyond(b)).collect();
        self.accept_smooth_runs(&mut rejected);
        // A reading that is repeated is as good as its first sample.
        self.repeated.iter().for_each(|&k| rejected[k] = rejected[k - 1]);
        rejected
    }

    /// Accepts runs that begin and end with steps as of the samples around them.
    fn accept_smooth_runs(&self, rejected: &mut [bool]) {
        let read: Vec<usize> =
            (0..rejected.len()).filter(|&k| self.values[k].is_finite()).collect();
        let flags: Vec<bool> = read.iter().map(|&k| rejected[k]).collect();
        let step =
            |at: usize| self.wrap_change(self.values[read[at]] - self.values[read[at - 1]]).abs();
        for (first, end) in flagged_runs(&flags) {
            let is_end = |at: usize| at == first || at == end;
            let near = first.saturating_sub(AROUND).max(1)..(end + AROUND).min(read.len());
            let mut others: Vec<f64> = near.filter(|&at| !is_end(at)).map(step).collect();
            others.sort_by(f64::total_cmp);
            let usual = others.get(others.len() / 2).copied().unwrap_or(0.0);
            let ends = [first, end].into_iter().filter(|&at| at > 0 && at < read.len());
            if ends.map(step).fold(0.0, f64::max) <= SMOOTH * usual {
                read[first..end].iter().for_each(|&k| rejected[k] = false);
            }
        }
    }
}

/// Returns the samples that repeat the reading before, of a recorder that is faster than its sensor.
fn held_samples(values: &[f64]) -> Vec<usize> {
    let repeated: Vec<usize> = (1..values.len()).filter(|&k| values[k] == values[k - 1]).collect();
    let is_held = repeated.len() as f64 > HELD * values.len() as f64;
    if is_held { repeated } else { Vec::new() }
}

/// Returns the 80 % quantile; `None` of nothing.
pub(super) fn upper_quantile(mut distances: Vec<f64>) -> Option<f64> {
    let at = (0.8 * distances.len() as f64) as usize;
    distances.get(at)?;
    Some(*distances.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// Returns the values less the integral of their rate (trapezoidal rule).
fn subtract_rate(t_s: &[f64], values: &[f64], rate: &[f64]) -> Vec<f64> {
    let (mut sum, mut last) = (0.0, None);
    let each = values.iter().zip(rate).zip(t_s);
    each.map(|((value, rate), t)| {
        if rate.is_finite() && t.is_finite() {
            if let Some((before, at)) = last {
                sum += 0.5 * (before + rate) * (t - at);
            }
            last = Some((*rate, *t));
        }
        value - sum
    })
    .collect()
}
