//! Faults of a recording, found by a robust filter: values that neither the samples before nor the
//! samples after explain.
//!
//! The filter estimates level and slope of a channel; where the rate of the channel is measured,
//! its integral is subtracted first. A value is rejected if it lies further from its prediction
//! than eight times the 80 % quantile of all such distances, and it is a fault if both the forward
//! and the backward pass reject it, so that a sudden manoeuvre is not a fault. The limit is ten
//! standard deviations of normal noise; of Laplace noise, whose tails are heavy, 3 in 10^6 samples
//! are beyond.

use std::f64::consts::{PI, TAU};

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
/// Minimum number of equal values in a run that may be a frozen sensor, and the expected number of
/// such runs by chance in a recording.
const FROZEN: usize = 8;
const BY_CHANCE: f64 = 1e-3;
/// Largest faulty fraction of a channel; with more, the filter rather than the samples is wrong.
const MAX_FAULTY_FRACTION: f64 = 0.2;
/// Maximum number of samples of a spike; longer faults are jumps.
const SPIKE: usize = 3;

/// A channel in SI units; a gap is NaN.
#[derive(Debug, Clone, Copy)]
pub struct FilteredChannel<'a> {
    /// One value for each sample.
    pub values: &'a [f64],
    /// Measured rate of the channel, where there is one.
    pub rate: Option<&'a [f64]>,
    /// True if the channel is a direction, which wraps at a full turn.
    pub is_direction: bool,
    /// Smallest distance from the prediction that is a fault, whatever the noise.
    pub least: f64,
    /// Magnitude above which a value is no reading of an instrument.
    pub impossible: f64,
}

/// Kind of fault of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SampleFault {
    /// A direction averaged across the full turn.
    WrappedAverage,
    /// A few samples that deviate from their neighbours.
    Spike,
    /// A longer run of samples that deviates from its neighbours.
    Jump,
    /// The last value, repeated.
    Frozen,
    /// A value that no instrument shows, such as -9999.
    Impossible,
}

impl SampleFault {
    /// Reason as written in a manifest.
    pub fn manifest_text(self) -> &'static str {
        match self {
            Self::WrappedAverage => "averages across the jump from 360 to 0 degrees",
            Self::Spike => "spikes",
            Self::Jump => "jumps that the values around do not explain",
            Self::Frozen => "frozen at one value",
            Self::Impossible => "placeholders for missing readings",
        }
    }
}

/// Returns the faults of a channel by sample, in order of the samples; none if more than a fifth
/// would be faulty.
pub fn sample_faults(t_s: &[f64], channel: &FilteredChannel) -> Vec<(usize, SampleFault)> {
    let mut values = channel.values.to_vec();
    let mut found: Vec<(usize, SampleFault)> = Vec::new();
    for (k, value) in values.iter_mut().enumerate().filter(|(_, v)| v.abs() > channel.impossible) {
        *value = f64::NAN;
        found.push((k, SampleFault::Impossible));
    }
    let filter = RobustFilter::new(t_s, &values, channel);
    let rejected = filter.rejected_samples(t_s);
    found.extend(flagged_runs(&rejected).into_iter().flat_map(|(first, end)| {
        let fault = classify_run(&values, channel.is_direction, first, end);
        (first..end).map(move |k| (k, fault))
    }));
    found.extend(frozen_samples(&values, &filter).into_iter().map(|k| (k, SampleFault::Frozen)));
    found.sort_unstable();
    found.dedup_by_key(|(k, _)| *k);
    // With so many faults the model of the filter does not describe the channel, so none is
    // reported.
    let many = found.len() as f64 > MAX_FAULTY_FRACTION * values.len() as f64;
    if many { Vec::new() } else { found }
}

/// Returns the smallest set of rows without which time increases strictly; none if that set is
/// large.
pub fn backward_times(t_s: &[f64]) -> Vec<usize> {
    // The longest strictly increasing subsequence (Fredman 1975, doi 10.1016/0012-365X(75)90103-X).
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = vec![None; t_s.len()];
    for k in (0..t_s.len()).filter(|&k| t_s[k].is_finite()) {
        // `ends[n]` is the row with the smallest time at which an increasing subsequence of length
        // n + 1 can end; `before` links each row to its predecessor in that subsequence.
        let place = ends.partition_point(|&at| t_s[at] < t_s[k]);
        before[k] = place.checked_sub(1).map(|place| ends[place]);
        match ends.get_mut(place) {
            Some(end) => *end = k,
            None => ends.push(k),
        }
    }
    // Follow the links backwards from the end of the longest subsequence.
    let mut kept = vec![false; t_s.len()];
    let mut at = ends.last().copied();
    while let Some(k) = at {
        kept[k] = true;
        at = before[k];
    }
    let dropped: Vec<usize> = (0..t_s.len()).filter(|&k| !kept[k]).collect();
    if dropped.len() as f64 > MAX_FAULTY_FRACTION * t_s.len() as f64 { Vec::new() } else { dropped }
}

/// Channel less the integral of its rate, and the largest innovation of a sample that is accepted.
struct RobustFilter {
    values: Vec<f64>,
    is_direction: bool,
    gate: f64,
}

impl RobustFilter {
    fn new(t_s: &[f64], values: &[f64], channel: &FilteredChannel) -> Self {
        let values = match channel.rate {
            Some(rate) => subtract_rate(t_s, values, rate),
            None => values.to_vec(),
        };
        let mut filter = Self { values, is_direction: channel.is_direction, gate: f64::INFINITY };
        let forward = filter.filter_samples(t_s, 0..t_s.len());
        let mut distances: Vec<f64> = forward.into_iter().flatten().map(f64::abs).collect();
        // The first pass accepts everything (infinite gate) and gives the distances that set the
        // gate.
        let at = (0.8 * distances.len() as f64) as usize;
        filter.gate = match distances.get(at) {
            Some(_) => {
                let quantile = *distances.select_nth_unstable_by(at, f64::total_cmp).1;
                (GATE * quantile).max(channel.least)
            }
            None => f64::INFINITY,
        };
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
            innovations[k] = Some(innovation / (1 + lost) as f64);
            if innovation.abs() > self.gate * (1 + lost) as f64 {
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
    fn wrap_change(&self, change: f64) -> f64 {
        if self.is_direction { change - ((change + PI) / TAU).floor() * TAU } else { change }
    }

    /// Flags the samples that both passes reject.
    fn rejected_samples(&self, t_s: &[f64]) -> Vec<bool> {
        let beyond = |innovation: Option<f64>| innovation.is_some_and(|one| one.abs() > self.gate);
        let forward = self.filter_samples(t_s, 0..t_s.len());
        let backward = self.filter_samples(t_s, (0..t_s.len()).rev());
        forward.into_iter().zip(backward).map(|(a, b)| beyond(a) && beyond(b)).collect()
    }
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

/// First and past-the-end index of every run of set flags.
fn flagged_runs(flags: &[bool]) -> Vec<(usize, usize)> {
    let (mut runs, mut k) = (Vec::new(), 0);
    while k < flags.len() {
        let end = (k..flags.len()).find(|&at| flags[at] != flags[k]).unwrap_or(flags.len());
        if flags[k] {
            runs.push((k, end));
        }
        k = end;
    }
    runs
}

fn classify_run(values: &[f64], is_direction: bool, first: usize, end: usize) -> SampleFault {
    // An average across the wrap lies between neighbours that are more than half a turn apart.
    let before = first.checked_sub(1).and_then(|k| values.get(k));
    let crosses = before.zip(values.get(end)).is_some_and(|(a, b)| (a - b).abs() > PI);
    match (is_direction && crosses, end - first <= SPIKE) {
        (true, _) => SampleFault::WrappedAverage,
        (false, true) => SampleFault::Spike,
        (false, false) => SampleFault::Jump,
    }
}

/// Returns the samples of runs of one value that are too long for chance and after which the
/// channel continues at another value.
fn frozen_samples(values: &[f64], filter: &RobustFilter) -> Vec<usize> {
    let equal: Vec<bool> = (0..values.len()).map(|k| k > 0 && values[k] == values[k - 1]).collect();
    let part = equal.iter().filter(|equal| **equal).count() as f64 / equal.len().max(1) as f64;
    // Channels that hold or round their readings have equal neighbours by nature.
    if part > 0.2 {
        return Vec::new();
    }
    // With the fraction p of equal neighbours, about n p^L runs of length L are expected by chance
    // among n samples: L follows from n p^L = BY_CHANCE.
    let longest = (BY_CHANCE / values.len() as f64).ln() / part.max(1e-4).ln();
    let longest = FROZEN.max(longest.ceil() as usize);
    let resumes = |first: usize, end: usize| {
        let stood = end < values.len() && (values[end] - values[first]).abs() > 0.0;
        let moved = filter.wrap_change(
            filter.values.get(end).copied().unwrap_or(f64::NAN) - filter.values[first],
        );
        stood && moved.abs() > filter.gate
    };
    let each = flagged_runs(&equal).into_iter().filter(|&(first, end)| end - first >= longest);
    each.filter(|&(first, end)| resumes(first, end)).flat_map(|(first, end)| first..end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(k: usize) -> f64 {
        ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5
    }

    fn heading() -> (Vec<f64>, Vec<f64>) {
        let t: Vec<f64> = (0..2000).map(|k| 0.5 * k as f64).collect();
        let psi = t.iter().enumerate().map(|(k, t)| (0.03 * t + 0.005 * noise(k)).rem_euclid(TAU));
        (t.clone(), psi.collect())
    }

    fn faults(t: &[f64], values: &[f64], is_direction: bool) -> Vec<(usize, SampleFault)> {
        let channel =
            FilteredChannel { values, rate: None, is_direction, least: 0.0, impossible: 5e3 };
        sample_faults(t, &channel)
    }

    #[test]
    fn a_clean_channel_has_no_fault_and_planted_ones_are_found() {
        let (t, mut psi) = heading();
        assert_eq!(faults(&t, &psi, true), []);
        let crossing = (1..psi.len()).find(|&k| psi[k] < psi[k - 1] - 3.0).unwrap_or(0);
        psi[crossing] = 0.5 * (psi[crossing - 1] + psi[crossing]);
        psi[700] += 0.8;
        psi[900] = -9999.0;
        let found = faults(&t, &psi, true);
        let wanted = [
            (crossing, SampleFault::WrappedAverage),
            (700, SampleFault::Spike),
            (900, SampleFault::Impossible),
        ];
        assert_eq!(found, wanted);
    }

    #[test]
    fn jumps_and_frozen_sensors_are_found_and_manoeuvres_are_not() {
        let t: Vec<f64> = (0..2000).map(|k| 0.5 * k as f64).collect();
        let ramp = |k: usize| if k > 1000 { 0.4 * (k - 1000) as f64 } else { 0.0 };
        let mut x: Vec<f64> =
            (0..2000).map(|k| 2.0 * k as f64 + ramp(k) + 0.1 * noise(k)).collect();
        assert_eq!(faults(&t, &x, false), []);
        (500..520).for_each(|k| x[k] += 60.0);
        (1500..1530).for_each(|k| x[k] = x[1499]);
        let found = faults(&t, &x, false);
        assert!((500..520).all(|k| found.contains(&(k, SampleFault::Jump))), "{found:?}");
        let late = found.iter().filter(|(k, _)| *k >= 1500).count();
        assert!((25..=30).contains(&late), "{late}");
        assert!(found.len() <= 52, "{}", found.len());
    }

    #[test]
    fn times_that_do_not_run_forward_are_named() {
        let mut t = vec![0.0, 1.0, 1.0, 2.0, 0.5, 3.0, 4.0, 99.0];
        t.extend((5..20).map(f64::from));
        assert_eq!(backward_times(&t), [1, 4, 7]);
    }
}
