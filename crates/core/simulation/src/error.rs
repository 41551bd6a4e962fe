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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{StateVector, at};

    const TURN: f64 = std::f64::consts::TAU;

    /// A trial with headings and roll, and a simulation of its second and fourth sample.
    fn compared(has_roll: bool) -> (Trial, TrialReplay) {
        let channels = [
            (Channel::U, vec![9.0, 2.0, 9.0, 4.0]),
            (Channel::Psi, vec![0.0, 0.1, 0.0, TURN - 0.2]),
            (Channel::Phi, vec![0.0, 0.3, 0.0, 0.3]),
        ];
        let t_s = vec![0.0, 1.0, 2.0, 3.0];
        let trial = Trial { t_s, channels: channels.into_iter().collect(), ..Trial::default() };
        let mut replay = TrialReplay::without_samples(has_roll);
        for (k, u, psi) in [(1, 5.0, 0.5), (3, 0.0, 0.1)] {
            let mut state = StateVector::zeros();
            (state[at::U], state[at::PSI]) = (u, psi);
            replay.track.push(trial.t_s[k], state, 1.0);
            replay.samples.push(k);
        }
        (trial, replay)
    }

    fn assert_near(own: Option<f64>, exact: f64) {
        assert!(own.is_some_and(|own| (own - exact).abs() < 1e-12), "{own:?} not {exact}");
    }

    #[test]
    fn differences_are_those_of_the_samples_with_headings_wrapped() {
        let (trial, replay) = compared(true);
        let error = SquaredError::from_trial(&trial, &replay);
        assert_near(error.channel_rmse(Channel::U), 12.5_f64.sqrt());
        assert_near(error.channel_rmse(Channel::Psi), 0.125_f64.sqrt());
        assert_near(error.channel_rmse(Channel::Phi), 0.3);
        assert_eq!(error.channel_rmse(Channel::R), None);
        let named = error.rmse_by_channel();
        assert_eq!(named.keys().collect::<Vec<_>>(), ["phi", "psi", "u"]);
        assert_near(named.get("u").copied(), 12.5_f64.sqrt());
        let without = SquaredError::from_trial(&trial, &compared(false).1).rmse_by_channel();
        assert_eq!(without.keys().collect::<Vec<_>>(), ["psi", "u"]);
    }

    #[test]
    fn sums_of_trials_weigh_by_their_samples() {
        let (trial, replay) = compared(true);
        let mut error = SquaredError::from_trial(&trial, &replay);
        let mut exact = replay;
        exact.track.states.iter_mut().zip([2.0, 4.0]).for_each(|(state, u)| state[at::U] = u);
        (0..2).for_each(|_| error.add(&SquaredError::from_trial(&trial, &exact)));
        assert_near(error.channel_rmse(Channel::U), (25.0 / 6.0_f64).sqrt());
    }

    /// By hand: squares 12.5 and 0.125 by variances of 4 and 0.5; what does not vary has no scale.
    #[test]
    fn an_error_is_standardised_by_the_deviations() {
        let (trial, replay) = compared(true);
        let error = SquaredError::from_trial(&trial, &replay);
        let scales = [(Channel::U, 2.0), (Channel::Psi, 0.5_f64.sqrt()), (Channel::Phi, 0.1)];
        let mse = standardised_mse(&error, &scales.into_iter().collect());
        assert_near(Some(mse), 3.125 + 0.25);
        let still = [(Channel::U, 2.0), (Channel::Psi, 0.0)].into_iter().collect();
        assert_near(Some(standardised_mse(&error, &still)), 3.125);
    }

    #[test]
    fn deviations_are_those_of_all_samples() {
        let trial = |u: &[f64]| Trial {
            t_s: (0..u.len()).map(|k| k as f64).collect(),
            channels: [(Channel::U, u.to_vec())].into_iter().collect(),
            ..Trial::default()
        };
        let scales = standard_deviations(&[&trial(&[1.0, 3.0]), &trial(&[5.0, 7.0])]);
        assert_near(scales.get(&Channel::U).copied(), 5.0_f64.sqrt());
        assert_eq!(scales.len(), 1);
    }
}
