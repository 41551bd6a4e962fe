//! Comparison of a rate with the channel whose rate it is: a sudden motion that both show is no
//! fault.

use super::filter::upper_quantile;
use super::filtered_channel::FilteredChannel;

/// Multiple of the noise of the integral that a run has to change it by, so that it can be judged.
const CLEAR: f64 = 4.0;
/// Largest misfit of the recorded run as a fraction of that of an interpolation across it.
const BETTER: f64 = 0.5;
/// 80 % quantile of the magnitude of normal noise, in standard deviations.
const QUANTILE: f64 = 1.28;

/// A rate, its integral as recorded, and the noise of a difference of the latter.
pub(super) struct IntegralCheck<'a> {
    t_s: &'a [f64],
    rate: &'a [f64],
    integral: &'a [f64],
    noise: f64,
}

impl<'a> IntegralCheck<'a> {
    /// Returns `None` if no sample has both.
    pub(super) fn new(
        t_s: &'a [f64],
        channel: &FilteredChannel<'a>,
        integral: &'a [f64],
    ) -> Option<Self> {
        let mut check = Self { t_s, rate: channel.values, integral, noise: 0.0 };
        let misfits = (1..t_s.len()).map(|k| (check.change(k - 1, k) - check.area(k - 1, k)).abs());
        let misfits: Vec<f64> = misfits.filter(|misfit| misfit.is_finite()).collect();
        check.noise = upper_quantile(misfits)? / QUANTILE;
        Some(check)
    }

    /// Returns true if the integral shows the motion of a run of samples.
    pub(super) fn confirms_run(&self, first: usize, end: usize) -> bool {
        let (Some(before), true) = (first.checked_sub(1), end < self.t_s.len()) else {
            return false;
        };
        let recorded = self.area(before, end);
        let mean = 0.5 * (self.rate[before] + self.rate[end]);
        let interpolated = mean * (self.t_s[end] - self.t_s[before]);
        let change = self.change(before, end);
        // Not finite where a neighbour is a gap: then nothing is confirmed.
        (recorded - interpolated).abs() > CLEAR * self.noise
            && (recorded - change).abs() < BETTER * (interpolated - change).abs()
    }

    /// Change of the integral by the recorded rate (trapezoidal rule).
    fn area(&self, first: usize, last: usize) -> f64 {
        let step =
            |k: usize| 0.5 * (self.rate[k] + self.rate[k + 1]) * (self.t_s[k + 1] - self.t_s[k]);
        (first..last).map(step).sum()
    }

    fn change(&self, first: usize, last: usize) -> f64 {
        self.integral[last] - self.integral[first]
    }
}
