//! Fixed-interval Kalman smoother (Rauch, Tung and Striebel 1965) for one recorded quantity and its
//! rates.
//!
//! Between samples the quantity is a parabola whose second derivative is disturbed by white noise:
//! value, rate and acceleration are the state, the density of the disturbance is the process noise.
//! Two numbers determine the smoothness of the result: the variance of a reading, and the process
//! noise. Neither is known of a file, so both are chosen by maximum likelihood of the readings:
//! their ratio is searched, and for each ratio the variance follows from the innovations.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

/// Largest number of samples of the longest segment from which the ratio is estimated; more would
/// hardly change it.
const MAX_SAMPLES: usize = 20_000;
/// Number of innovations ignored at the start of a segment, where they only determine the initial
/// state.
const IGNORED_INNOVATIONS: usize = 3;
/// Range of the decimal logarithm in which the ratio is searched, in units of the median step.
const RATIOS: Range<i32> = -14..5;
/// Factor of the initial variances of value, rate and acceleration: the readings from which they
/// are computed are used again, so that the initial state must have little weight, but its variance
/// must not be so large that rounding spoils what remains of it.
const DIFFUSE: f64 = 100.0;
/// Smallest variance of a reading by the square of the readings' range: the rounding of a
/// simulation.
const EXACT: f64 = 1e-24;

/// Estimated noise of the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NoiseLevels {
    /// Variance of a reading.
    pub reading: f64,
    /// Density of the disturbance of the acceleration, divided by the variance of a reading, 1/s^5.
    pub ratio: f64,
}

/// Smoothed value and rate with their variances.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SmoothedState {
    pub value: f64,
    pub rate: f64,
    pub value_variance: f64,
    pub rate_variance: f64,
}

#[derive(Clone, Copy)]
struct FilterState {
    mean: Vector3<f64>,
    covariance: Matrix3<f64>,
}

/// Constant acceleration over the step: rows for value, rate and acceleration.
fn transition_matrix(step: f64) -> Matrix3<f64> {
    Matrix3::new(1.0, step, 0.5 * step * step, 0.0, 1.0, step, 0.0, 0.0, 1.0)
}

/// Covariance that white noise of density `ratio` on the third derivative adds over the step.
fn disturbance_covariance(step: f64, ratio: f64) -> Matrix3<f64> {
    let [two, three, four, five] = [2, 3, 4, 5].map(|power| step.powi(power));
    let (a, b, c) = (five / 20.0, four / 8.0, three / 6.0);
    ratio * Matrix3::new(a, b, c, b, three / 3.0, 0.5 * two, c, 0.5 * two, step)
}

impl FilterState {
    /// Returns the state at the first sample, in units in which a reading has variance 1.
    fn initial_state(t: &[f64], values: &[f64], ratio: f64) -> Self {
        let step = t[1] - t[0];
        // Rate and acceleration from the differences of the first three readings.
        let rate = (values[1] - values[0]) / step;
        let next = (values[2] - values[1]) / (t[2] - t[1]);
        let acceleration = (next - rate) / (0.5 * (t[2] - t[0]));
        let mean = Vector3::new(values[0], rate - 0.5 * step * acceleration, acceleration);
        let variance = DIFFUSE
            * Vector3::new(
                1.0,
                6.0 / step.powi(2) + ratio * step.powi(3),
                6.0 / step.powi(4) + ratio * step,
            );
        Self { mean, covariance: Matrix3::from_diagonal(&variance) }
    }

    fn predict_step(&self, step: f64, ratio: f64) -> Self {
        let f = transition_matrix(step);
        let covariance = f * self.covariance * f.transpose() + disturbance_covariance(step, ratio);
        Self { mean: f * self.mean, covariance }
    }

    /// Updates the state with a reading; returns it with the innovation and its variance.
    fn update_with(&self, value: f64) -> (Self, f64, f64) {
        let (innovation, variance) = (value - self.mean[0], self.covariance[(0, 0)] + 1.0);
        let gain = self.covariance.column(0) / variance;
        let covariance = self.covariance - gain * gain.transpose() * variance;
        // Symmetric again, against the growth of rounding errors.
        let covariance = 0.5 * (covariance + covariance.transpose());
        (Self { mean: self.mean + gain * innovation, covariance }, innovation, variance)
    }
}

/// Returns sums over the innovations of one quantity: of squares divided by the variance, of
/// logarithms of the variance, and their number.
fn innovation_sums(t: &[f64], values: &[f64], ratio: f64) -> (f64, f64, f64) {
    let mut state = FilterState::initial_state(t, values, ratio);
    let mut sums = (0.0, 0.0, 0.0);
    for k in 1..t.len() {
        let (next, innovation, variance) =
            state.predict_step(t[k] - t[k - 1], ratio).update_with(values[k]);
        state = next;
        if k > IGNORED_INNOVATIONS {
            sums.0 += innovation * innovation / variance;
            sums.1 += variance.ln();
            sums.2 += 1.0;
        }
    }
    sums
}

/// Returns the most likely noise of quantities with equal reading noise, from the longest segment
/// without a gap; `None` if that is too short.
pub(crate) fn estimate_noise(
    t: &[f64],
    quantities: &[&[f64]],
    segments: &[Range<usize>],
) -> Option<NoiseLevels> {
    let longest = segments.iter().max_by_key(|range| range.len())?;
    let range = longest.start..longest.end.min(longest.start + MAX_SAMPLES);
    let (t, count) = (&t[range.clone()], range.len());
    if count < 2 + 2 * IGNORED_INNOVATIONS {
        return None;
    }
    let step = (t[count - 1] - t[0]) / (count - 1) as f64;
    // A lower bound, since readings without noise would give a variance of zero.
    let least =
        quantities.iter().map(|values| EXACT * value_spread(&values[range.clone()]).powi(2));
    let least = least.fold(f64::MIN_POSITIVE, f64::max);
    // Minus twice the log likelihood, up to a constant, with the variance of a reading concentrated
    // out.
    let noise = |exponent: f64| {
        let ratio = 10_f64.powf(exponent) / step.powi(5);
        let sums =
            quantities.iter().map(|values| innovation_sums(t, &values[range.clone()], ratio));
        let (squares, logarithms, count) =
            sums.fold((0.0, 0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2));
        let reading = (squares / count).max(least);
        (NoiseLevels { reading, ratio }, count * reading.ln() + logarithms)
    };
    // A search over decades, refined by halving the width: one exponent, and a smooth objective.
    let (mut centre, mut width) = (best_exponent(RATIOS.map(f64::from), &noise), 0.5);
    for _ in 0..4 {
        centre = best_exponent([centre - width, centre, centre + width].into_iter(), &noise);
        width *= 0.5;
    }
    Some(noise(centre).0)
}

fn best_exponent(
    exponents: impl Iterator<Item = f64>,
    noise: &impl Fn(f64) -> (NoiseLevels, f64),
) -> f64 {
    let judged = exponents.map(|exponent| (exponent, noise(exponent).1));
    judged.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |(exponent, _)| exponent)
}

fn value_spread(values: &[f64]) -> f64 {
    let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    most - least
}

/// Smooths a segment without a gap, of at least three samples.
pub(crate) fn rts_smooth(t: &[f64], values: &[f64], noise: NoiseLevels) -> Vec<SmoothedState> {
    let mut states = Vec::with_capacity(t.len());
    states.push(FilterState::initial_state(t, values, noise.ratio));
    for k in 1..t.len() {
        let before: FilterState = states[k - 1];
        states.push(before.predict_step(t[k] - t[k - 1], noise.ratio).update_with(values[k]).0);
    }
    // Backward pass of Rauch, Tung and Striebel. A singular prediction leaves the filtered state.
    for k in (0..t.len() - 1).rev() {
        let (after, filtered) = (states[k + 1], states[k]);
        let step = t[k + 1] - t[k];
        let predicted = filtered.predict_step(step, noise.ratio);
        let Some(inverse) = predicted.covariance.try_inverse() else { continue };
        let gain = filtered.covariance * transition_matrix(step).transpose() * inverse;
        let change = gain * (after.covariance - predicted.covariance) * gain.transpose();
        let covariance = filtered.covariance + 0.5 * (change + change.transpose());
        states[k] =
            FilterState { mean: filtered.mean + gain * (after.mean - predicted.mean), covariance };
    }
    states.iter().map(|state| SmoothedState::from_state(state, noise.reading)).collect()
}

impl SmoothedState {
    fn from_state(state: &FilterState, reading: f64) -> Self {
        let variance = |k: usize| reading * state.covariance[(k, k)].max(0.0);
        Self {
            value: state.mean[0],
            rate: state.mean[1],
            value_variance: variance(0),
            rate_variance: variance(1),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::single_range_in_vec_init)]
    use super::*;

    /// Nearly normal numbers of variance 1: the sum of twelve even ones.
    fn noise(count: usize) -> Vec<f64> {
        let mut seed = 7_u64;
        let mut even = move || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| (0..12).map(|_| even()).sum::<f64>() - 6.0).collect()
    }

    #[test]
    fn rates_of_a_noisy_sine_come_back_within_their_standard_deviations() {
        let t: Vec<f64> = (0..3000).map(|k| 0.1 * f64::from(k)).collect();
        let errors = noise(t.len());
        let values: Vec<f64> =
            t.iter().zip(&errors).map(|(t, e)| 10.0 * (0.1 * t).sin() + 0.05 * e).collect();
        let found = estimate_noise(&t, &[&values], &[0..t.len()]).unwrap();
        assert!((found.reading.sqrt() - 0.05).abs() < 0.005, "{found:?}");
        let smoothed = rts_smooth(&t, &values, found);
        let within = t.iter().zip(&smoothed).filter(|(t, smoothed)| {
            (smoothed.rate - (0.1 * **t).cos()).abs() < 2.0 * smoothed.rate_variance.sqrt()
        });
        let share = within.count() as f64 / t.len() as f64;
        assert!(share > 0.85, "{share}");
        let middle = smoothed[1500];
        assert!((middle.rate - 15.0_f64.cos()).abs() < 0.03, "{middle:?}");
        let first = smoothed[0].rate_variance;
        assert!(first > 4.0 * middle.rate_variance, "{first} {middle:?}");
    }

    #[test]
    fn exact_readings_give_exact_rates_at_uneven_steps() {
        let t: Vec<f64> = (0..200).map(|k| 0.5 * f64::from(k) + 0.1 * f64::from(k % 3)).collect();
        let values: Vec<f64> = t.iter().map(|t| 3.0 + 2.0 * t - 0.01 * t * t).collect();
        let found = estimate_noise(&t, &[&values], &[0..t.len()]).unwrap();
        for (t, smoothed) in t.iter().zip(rts_smooth(&t, &values, found)) {
            assert!((smoothed.rate - 2.0 + 0.02 * t).abs() < 1e-4, "{smoothed:?}");
        }
    }

    #[test]
    fn constant_and_short_records_end() {
        let t: Vec<f64> = (0..50).map(f64::from).collect();
        let found = estimate_noise(&t, &[&[1.0; 50]], &[0..50]).unwrap();
        assert!(
            rts_smooth(&t, &[1.0; 50], found).iter().all(|smoothed| smoothed.rate.abs() < 1e-9)
        );
        assert_eq!(estimate_noise(&t, &[&[1.0; 50]], &[0..5, 5..9]), None);
        assert_eq!(rts_smooth(&t[..3], &[1.0, 2.0, 3.0], found).len(), 3);
    }
}
