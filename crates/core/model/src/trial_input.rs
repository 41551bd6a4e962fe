//! Inputs of a law as a trial gives them.

use std::borrow::Cow;

use crate::effect::{TIME_INPUT, input_channel};
use crate::trial::{Channel, Trial};

/// Input of a law on a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum TrialInput<'a> {
    /// A value for each sample: a recorded channel, or the time since the first sample, s.
    Samples(Cow<'a, [f64]>),
    /// The trial's constant depth, or the default of the law.
    Constant(f64),
}

/// The error type for an input that a trial does not give and that has no default.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MissingInput {
    /// The trial does not record the channel.
    #[error("trial `{trial}` has no channel `{channel}`, which the simulation needs")]
    Channel {
        /// The trial.
        trial: String,
        /// The missing channel.
        channel: Channel,
    },
    /// No trial can record the input.
    #[error("no trial can record the input `{0}`; give it a default, or choose another law")]
    Unrecordable(String),
}

/// Returns an input of a law on a trial: the time, its channel, the trial's constant depth, or the
/// law's default.
///
/// # Errors
/// Returns an error with the missing channel, or with the input if there is no channel for it.
pub fn find_input<'a>(
    trial: &'a Trial,
    name: &str,
    default: Option<f64>,
) -> Result<TrialInput<'a>, MissingInput> {
    if name == TIME_INPUT {
        return Ok(TrialInput::Samples(Cow::Owned(elapsed_times(trial))));
    }
    let channel = input_channel(name);
    if let Some(column) = channel.and_then(|channel| trial.channel(channel)) {
        return Ok(TrialInput::Samples(Cow::Borrowed(column)));
    }
    let depth_m = trial.depth_m.filter(|_| channel == Some(Channel::Depth));
    let missing = || match channel {
        Some(channel) => MissingInput::Channel { trial: trial.name.clone(), channel },
        None => MissingInput::Unrecordable(name.to_owned()),
    };
    depth_m.or(default).map(TrialInput::Constant).ok_or_else(missing)
}

/// Times since the first sample, s.
fn elapsed_times(trial: &Trial) -> Vec<f64> {
    let start = trial.t_s.first().copied().unwrap_or_default();
    trial.t_s.iter().map(|t| t - start).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn wind_trial() -> Trial {
        let mut trial =
            Trial { name: "windy".into(), t_s: vec![5.0, 6.0, 7.5], ..Trial::default() };
        trial.channels.insert(Channel::WindSpeed, vec![8.0, 9.0, 10.0]);
        trial
    }

    #[test]
    fn a_record_comes_before_the_default() {
        let trial = wind_trial();
        let found = find_input(&trial, "wind_speed", Some(0.0)).unwrap();
        assert_eq!(found, TrialInput::Samples(Cow::Borrowed(&[8.0, 9.0, 10.0][..])));
        let found = find_input(&trial, "wind_from", Some(0.5)).unwrap();
        assert_eq!(found, TrialInput::Constant(0.5));
    }

    #[test]
    fn the_depth_of_the_trial_comes_before_the_default_and_serves_the_depth_alone() {
        let trial = Trial { depth_m: Some(12.0), ..wind_trial() };
        assert_eq!(find_input(&trial, "depth", Some(99.0)).unwrap(), TrialInput::Constant(12.0));
        let missing = find_input(&trial, "n", None).unwrap_err();
        assert_eq!(missing, MissingInput::Channel { trial: "windy".into(), channel: Channel::N });
    }

    #[test]
    fn time_counts_from_the_first_sample() {
        let trial = wind_trial();
        let found = find_input(&trial, TIME_INPUT, Some(0.0)).unwrap();
        assert_eq!(found, TrialInput::Samples(Cow::Owned(vec![0.0, 1.0, 2.5])));
    }

    #[test]
    fn an_input_without_a_channel_is_reported_by_its_name() {
        let missing = find_input(&wind_trial(), "ballast", None).unwrap_err();
        assert_eq!(missing, MissingInput::Unrecordable("ballast".into()));
        assert!(missing.to_string().contains("`ballast`"), "{missing}");
    }
}
