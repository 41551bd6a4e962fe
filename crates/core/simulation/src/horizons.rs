//! Errors of simulations that restart at several intervals, combined into one criterion.
//!
//! A bias in yaw moment or sway force grows with the length of a simulation: over five ship lengths
//! it is less than the noise of the readings, over a whole trial it is not. Errors of long
//! simulations alone are mostly due to gusts and to the noise of one starting state. The criterion
//! is therefore the geometric mean of the standardised errors at every restart interval: its
//! logarithm is, up to constants, the negative log-likelihood of Gaussian errors whose variance at
//! each interval is not known (the profile likelihood, `n/2 ln` of the mean square, summed), so
//! that each interval counts by ratios, whatever its size.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};

use crate::error::{SquaredError, standardised_mse};
use crate::recorded::TrialReplay;
use crate::state::RECORDED_CHANNELS;

/// Standardised squared error per channel for samples that were not simulated because the
/// simulation stopped, and the most of any channel: that of two independent motions of the same
/// variance, `E (a - b)^2 = 2 s^2`.
const STOPPED_ERROR: f64 = 2.0;

/// Standardised squared errors of simulations with one restart interval.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HorizonErrors {
    /// Mean over all samples.
    pub mean: f64,
    /// Mean over the samples of each trial.
    pub each: Vec<f64>,
}

impl HorizonErrors {
    /// Errors of simulations that all reached their end.
    pub fn new(
        total: &SquaredError,
        each: &[SquaredError],
        deviations: &BTreeMap<Channel, f64>,
    ) -> Self {
        let of = |error: &SquaredError| standardised_mse(error, deviations);
        Self { mean: of(total), each: each.iter().map(of).collect() }
    }

    /// Errors of simulations that may have stopped early; samples after a stop count as
    /// [`UNRELATED`].
    pub fn with_stops(
        trials: &[&Trial],
        runs: &[TrialReplay],
        deviations: &BTreeMap<Channel, f64>,
    ) -> Self {
        let one = |(trial, run): (&&Trial, &TrialReplay)| error_with_stop(trial, run, deviations);
        let each: Vec<f64> = trials.iter().zip(runs).map(one).collect();
        // The overall mean weights each trial by its number of samples.
        let weighted = trials.iter().zip(&each).map(|(trial, error)| error * trial.len() as f64);
        let samples: usize = trials.iter().map(|trial| trial.len()).sum();
        Self { mean: weighted.sum::<f64>() / samples.max(1) as f64, each }
    }
}

/// Mean over all samples of a trial, summed over the channels that it has and that vary: simulated
/// samples with their error, the others as unrelated motions. A channel counts no more than an
/// unrelated motion: how much further a simulation is off, such as the position of an unstable ship
/// after a heading error of minutes, does not tell models apart, and would outweigh all other trials.
fn error_with_stop(trial: &Trial, run: &TrialReplay, deviations: &BTreeMap<Channel, f64>) -> f64 {
    let error = SquaredError::from_trial(trial, run);
    let (simulated, all) = (run.samples.len() as f64, trial.len().max(1) as f64);
    let one = |&(channel, _): &(Channel, usize)| {
        let deviation = deviations.get(&channel).filter(|deviation| **deviation > 0.0)?;
        trial.channel(channel)?;
        let own = error.channel_rmse(channel).map_or(0.0, |rmse| (rmse / deviation).powi(2));
        let mean = (own * simulated + STOPPED_ERROR * (all - simulated)) / all;
        // `min` would return the bound for an error that is not a number.
        Some(if mean > STOPPED_ERROR { STOPPED_ERROR } else { mean })
    };
    // The first six recorded channels are those of the standardised error; roll is not among them.
    RECORDED_CHANNELS[..6].iter().filter_map(one).sum()
}

/// Returns the criterion and the share of each trial in it: the mean of the shares is the geometric
/// mean of the means over trials, and their scatter is, to first order, that of the criterion's
/// logarithm times the criterion.
pub fn combine_horizons(horizons: &[HorizonErrors]) -> (f64, Vec<f64>) {
    // A single interval needs no combination.
    match horizons {
        [] => return (0.0, Vec::new()),
        [only] => return (only.mean, only.each.clone()),
        _ => {}
    }
    let mean = geometric_mean(horizons.iter().map(|horizon| horizon.mean));
    let trials = horizons.iter().map(|horizon| horizon.each.len()).min().unwrap_or(0);
    let means: Vec<f64> = horizons
        .iter()
        .map(|horizon| horizon.each.iter().sum::<f64>() / trials.max(1) as f64)
        .collect();
    let scale = geometric_mean(means.iter().copied());
    // First-order expansion of the geometric mean about the means over trials.
    let share = |trial: usize| {
        let ratios = horizons.iter().zip(&means);
        let ratios = ratios.map(|(horizon, mean)| horizon.each[trial] / mean.max(SMALLEST_ERROR));
        scale * ratios.sum::<f64>() / horizons.len() as f64
    };
    (mean, (0..trials).map(share).collect())
}

/// Lower bound of an error before its logarithm is taken.
const SMALLEST_ERROR: f64 = f64::MIN_POSITIVE;

fn geometric_mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|value| value.max(SMALLEST_ERROR).ln()).sum::<f64>() / count).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{StateVector, at};

    fn horizon(each: &[f64]) -> HorizonErrors {
        HorizonErrors { mean: each.iter().sum::<f64>() / each.len() as f64, each: each.to_vec() }
    }

    #[test]
    fn one_horizon_is_itself() {
        let only = horizon(&[0.1, 0.3]);
        assert_eq!(combine_horizons(std::slice::from_ref(&only)), (only.mean, only.each));
        assert_eq!(combine_horizons(&[]), (0.0, Vec::new()));
    }

    #[test]
    fn horizons_count_by_ratios_and_trials_by_their_share() {
        let (short, long) = (horizon(&[0.01, 0.03]), horizon(&[2.0, 6.0]));
        let (mean, each) = combine_horizons(&[short.clone(), long]);
        assert!((mean - (0.02_f64 * 4.0).sqrt()).abs() < 1e-12);
        assert!((each.iter().sum::<f64>() / 2.0 - mean).abs() < 1e-12);
        assert!((each[1] / each[0] - 3.0).abs() < 1e-12);
        // Twice the long error is a factor of the root of two, whatever its size.
        let (doubled, _) = combine_horizons(&[short, horizon(&[4.0, 12.0])]);
        assert!((doubled / mean - 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_channel_counts_no_more_than_an_unrelated_motion() {
        let t_s: Vec<f64> = (0..10).map(f64::from).collect();
        let channels = [(Channel::Y, vec![0.0; 10]), (Channel::R, vec![0.0; 10])].into();
        let trial = Trial { t_s: t_s.clone(), channels, ..Trial::default() };
        let error_at = |y_m: f64, r_rad_s: f64, simulated: usize| {
            let mut state = StateVector::zeros();
            (state[at::Y], state[at::R]) = (y_m, r_rad_s);
            let mut run = TrialReplay::without_samples(false);
            (run.samples, run.track.states) = ((0..simulated).collect(), vec![state; simulated]);
            let deviations = [(Channel::Y, 2.0), (Channel::R, 0.1)].into();
            HorizonErrors::with_stops(&[&trial], &[run], &deviations).mean
        };
        assert!((error_at(1.0, 0.05, 10) - 0.5).abs() < 1e-12);
        assert!((error_at(1000.0, 0.05, 10) - 2.25).abs() < 1e-12, "the position alone is lost");
        assert!((error_at(0.0, 0.0, 5) - 2.0).abs() < 1e-12, "half of both is not simulated");
        assert!(!error_at(f64::NAN, 0.0, 10).is_finite());
    }

    #[test]
    fn errors_of_nothing_are_finite() {
        let (mean, each) = combine_horizons(&[horizon(&[0.0, 0.0]), horizon(&[1.0, 1.0])]);
        assert!(mean < 1e-100 && each.iter().all(|error| error.is_finite()));
    }
}
