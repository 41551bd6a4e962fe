//! Interpolation between samples by a cubic that never leaves the range of its two neighbours.
//!
//! A rudder moves smoothly between the samples of a slow recorder; linear interpolation cuts the
//! corners, and half a degree for a second is a metre of track. Noise is not amplified, since the
//! cubic has no overshoot (Fritsch and Carlson 1980, SIAM J Numer Anal 17, 238-246, with the
//! harmonic mean of Fritsch and Butland 1984).

use std::borrow::Cow;

/// Monotone cubic through samples.
#[derive(Debug, Clone)]
pub struct MonotoneCubic<'a> {
    t: &'a [f64],
    values: Cow<'a, [f64]>,
    slopes: Vec<f64>,
}

impl<'a> MonotoneCubic<'a> {
    /// Creates the cubic through values at increasing times.
    pub fn new(t: &'a [f64], values: impl Into<Cow<'a, [f64]>>) -> Self {
        let values = values.into();
        let secant = |k: usize| (values[k + 1] - values[k]) / (t[k + 1] - t[k]);
        let inner = |k: usize| {
            let (before, after) = (secant(k - 1), secant(k));
            // Slope zero at an extremum, otherwise the harmonic mean of the neighbouring secants.
            if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
        };
        let n = values.len();
        let slope = |k: usize| match k {
            _ if n < 2 => 0.0,
            // End slopes are the secants of the first and the last interval.
            0 => secant(0),
            k if k + 1 == n => secant(n - 2),
            k => inner(k),
        };
        let slopes = (0..n).map(slope).collect();
        Self { t, values, slopes }
    }

    /// Value at a fraction `w` of the way from sample `k` to the next; for the last sample, the
    /// sample.
    pub fn interpolate_at(&self, k: usize, w: f64) -> f64 {
        if k + 1 < self.values.len() { self.interpolate_between(k, w) } else { self.values[k] }
    }

    /// Value at a fraction `w` of the way from sample `k` to the next.
    pub fn interpolate_between(&self, k: usize, w: f64) -> f64 {
        let step = self.t[k + 1] - self.t[k];
        let (a, b) = (self.values[k], self.values[k + 1]);
        let (da, db) = (self.slopes[k] * step, self.slopes[k + 1] * step);
        let (w2, w3) = (w * w, w * w * w);
        // Cubic Hermite basis in w.
        a + (3.0 * w2 - 2.0 * w3) * (b - a) + (w - 2.0 * w2 + w3) * da + (w3 - w2) * db
    }
}

/// Returns the response of a first-order lag to samples that are interpolated linearly; it starts
/// in steady state.
pub fn apply_lag(t: &[f64], values: &[f64], time_constant_s: f64) -> Vec<f64> {
    let mut out = values.to_vec();
    for k in 1..values.len() {
        // Interval in time constants; the lower limit avoids a division by zero.
        let x = (t[k] - t[k - 1]) / time_constant_s.max(1e-9);
        let decay = (-x).exp();
        let (from, slope) = (values[k - 1], (values[k] - values[k - 1]) / x);
        // Response to a ramp of `slope` per time constant, from the previous output.
        out[k] = values[k] - slope + (out[k - 1] - from + slope) * decay;
    }
    out
}

/// Returns the response of a dead band (play, or backlash): it follows the samples only where they
/// leave a band of half width `half` about it, and starts with the first sample.
pub fn apply_dead_band(values: &[f64], half: f64) -> Vec<f64> {
    let mut out = values.to_vec();
    for k in 1..values.len() {
        out[k] = out[k - 1].max(values[k] - half).min(values[k] + half);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_behind_a_play_follows_at_a_distance_and_turns_late() {
        let recorded = [0.0, 0.5, 3.0, 2.5, 1.5, 0.0, 0.5];
        assert_eq!(apply_dead_band(&recorded, 1.0), [0.0, 0.0, 2.0, 2.0, 2.0, 1.0, 1.0]);
        assert_eq!(apply_dead_band(&recorded, 0.0), recorded);
    }

    #[test]
    fn lines_are_exact_and_steps_do_not_overshoot() {
        let t = [0.0, 1.0, 2.0, 3.0, 4.0];
        let line = MonotoneCubic::new(&t, vec![0.0, 2.0, 4.0, 6.0, 8.0]);
        assert!((line.interpolate_between(1, 0.3) - 2.6).abs() < 1e-12);
        let step = [0.0, 0.0, 1.0, 1.0, 1.0];
        let cubic = MonotoneCubic::new(&t, step.to_vec());
        assert!(
            (0..=100)
                .all(|i| (0.0..=1.0).contains(&cubic.interpolate_between(1, f64::from(i) / 100.0)))
        );
        assert_eq!(
            (cubic.interpolate_between(1, 0.0), cubic.interpolate_between(1, 1.0)),
            (0.0, 1.0)
        );
    }

    #[test]
    fn an_exponential_is_followed_better_than_by_lines() {
        let t: Vec<f64> = (0..12).map(|k| 0.5 * f64::from(k)).collect();
        let values: Vec<f64> = t.iter().map(|t| (-t).exp()).collect();
        let cubic = MonotoneCubic::new(&t, values.clone());
        for k in 1..10 {
            let exact = (-(t[k] + 0.25)).exp();
            let linear = 0.5 * (values[k] + values[k + 1]);
            assert!(
                (cubic.interpolate_between(k, 0.5) - exact).abs() < 0.2 * (linear - exact).abs()
            );
        }
    }

    #[test]
    fn a_lag_follows_a_ramp_one_time_constant_behind() {
        let t: Vec<f64> = (0..200).map(|k| 0.5 * f64::from(k)).collect();
        let out = apply_lag(&t, &t, 3.0);
        assert!((out[199] - (t[199] - 3.0)).abs() < 1e-9);
        assert!(apply_lag(&t, &t, 0.0).iter().zip(&t).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}
