//! Difference between simulated and measured trials.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};

use crate::recorded::TrialReplay;
use crate::state::RECORDED_CHANNELS;

/// Sums of squared differences by channel, which add over trials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SquaredError {
    sums: BTreeMap<Channel, (f64, usize)>,
}

impl SquaredError {
    /// Differences of one simulated trial; that of the heading is wrapped to half a turn. Roll
    /// counts for 4-DOF models only.
    pub fn from_trial(trial: &Trial, replay: &TrialReplay) -> Self {
        let mut error = Self::default();
        let compared = RECORDED_CHANNELS.iter().filter(|(channel, _)| {
            replay.has_roll || !matches!(channel, Channel::Phi | Channel::P)
        });
        for &(channel, index) in compared {
            let Some(measured) = trial.channel(channel) else { continue };
            let square = |(state, &k): (&crate::StateVector, &usize)| {
                channel_difference(channel, state[index], measured[k]).powi(2)
            };
            let sum = replay.track.states.iter().zip(&replay.samples).map(square).sum();
            error.sums.insert(channel, (sum, replay.samples.len()));
        }
        error
    }

    /// Adds the sums of another trial.
    pub fn add(&mut self, other: &Self) {
        for (channel, (sum, count)) in &other.sums {
            let entry = self.sums.entry(*channel).or_default();
            entry.0 += sum;
            entry.1 += count;
        }
    }

    /// Root mean square by channel name; channels without simulated samples are absent.
    pub fn rmse_by_channel(&self) -> BTreeMap<String, f64> {
        let named =
            |channel: &Channel| Some((channel.name().to_owned(), self.channel_rmse(*channel)?));
        self.sums.keys().filter_map(named).collect()
    }

    /// Root mean square of one channel; `None` without simulated samples.
    pub fn channel_rmse(&self, channel: Channel) -> Option<f64> {
        self.sums
            .get(&channel)
            .filter(|(_, count)| *count > 0)
            .map(|(sum, count)| (sum / *count as f64).sqrt())
    }
}

fn channel_difference(channel: Channel, simulated: f64, measured: f64) -> f64 {
    let plain = simulated - measured;
    if channel == Channel::Psi { wrap_angle(plain) } else { plain }
}

/// Wraps an angle to (-pi, pi].
pub fn wrap_angle(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    // Subtracts the nearest whole number of turns.
    angle - turn * (angle / turn).round()
}

/// Standard deviations of the compared channels over trials, the scale of [`standardised_mse`].
pub fn standard_deviations(trials: &[&Trial]) -> BTreeMap<Channel, f64> {
    let of = |channel: Channel| {
        let values: Vec<f64> =
            trials.iter().filter_map(|trial| trial.channel(channel)).flatten().copied().collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance =
            values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        (!values.is_empty()).then(|| variance.sqrt())
    };
    RECORDED_CHANNELS.iter().filter_map(|&(channel, _)| Some((channel, of(channel)?))).collect()
}

/// The standardised mean squared error of Wakita et al. 2022, Eq. 26: the mean over samples of the
/// squared differences of `u, v, r, psi, x, y`, each divided by its standard deviation, summed over
/// the channels that the trial has.
pub fn standardised_mse(error: &SquaredError, deviations: &BTreeMap<Channel, f64>) -> f64 {
    let term = |&(channel, _): &(Channel, usize)| {
        let (rmse, deviation) = (error.channel_rmse(channel)?, deviations.get(&channel)?);
        // A channel without variation has no scale, and does not count.
        (*deviation > 0.0).then(|| (rmse / deviation).powi(2))
    };
    RECORDED_CHANNELS[..6].iter().filter_map(term).sum()
}
