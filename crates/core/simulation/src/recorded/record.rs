//! Channels of a trial in the form that a simulation reads.

use sistership_model::effect::{TIME_INPUT, input_channel};
use sistership_model::trial::{Channel, Trial};

use crate::interpolate::{MonotoneCubic, apply_dead_band, apply_lag};
use crate::plant::{LawInputs, MAX_INPUTS};
use crate::ship::Ship;
use crate::state::{RECORDED_CHANNELS, StateVector, at};

/// Error of a trial that cannot be simulated.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("trial `{trial}` has no channel `{channel}`, which the simulation needs")]
pub struct MissingChannel {
    /// The trial.
    pub trial: String,
    /// The missing channel.
    pub channel: Channel,
}

/// Channels of a trial that a simulation reads.
pub struct TrialRecord<'a> {
    pub trial: &'a Trial,
    pub delta: &'a [f64],
    pub n: Option<&'a [f64]>,
    /// Each input of the law: recorded, or a constant.
    inputs: Vec<Result<MonotoneCubic<'a>, f64>>,
    start: Vec<(usize, &'a [f64])>,
}

impl<'a> TrialRecord<'a> {
    pub fn new(ship: &Ship, trial: &'a Trial) -> Result<Self, MissingChannel> {
        let need = |channel| {
            trial
                .channel(channel)
                .ok_or_else(|| MissingChannel { trial: trial.name.clone(), channel })
        };
        // Velocities must be known at the start of a part; heading and position start at zero if
        // they were not recorded.
        for (channel, _) in &RECORDED_CHANNELS[..3] {
            need(*channel)?;
        }
        let start = RECORDED_CHANNELS
            .iter()
            .filter_map(|&(channel, index)| Some((index, trial.channel(channel)?)))
            .collect();
        let of = |figures: &[(usize, f64)], place: usize| {
            figures.iter().find(|(of, _)| *of == place).map_or(0.0, |&(_, figure)| figure)
        };
        let follows = |place: usize| (of(ship.input_lags_s(), place), of(ship.dead_bands(), place));
        let inputs = ship.law_inputs().enumerate();
        let inputs = inputs
            .map(|(place, (name, default))| law_input(trial, name, default, follows(place)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            trial,
            delta: need(Channel::Delta)?,
            n: trial.channel(Channel::N),
            inputs,
            start,
        })
    }

    pub fn recorded_state(&self, sample: usize) -> StateVector {
        let mut state = StateVector::zeros();
        self.start.iter().for_each(|(index, column)| state[*index] = column[sample]);
        state[at::DELTA] = self.delta[sample];
        state
    }

    /// Inputs at a fraction of the way from a sample to the next.
    pub fn interpolate_inputs(&self, k: usize, w: f64) -> LawInputs {
        let mut inputs = [0.0; MAX_INPUTS];
        for (value, input) in inputs.iter_mut().zip(&self.inputs) {
            *value = input
                .as_ref()
                .map_or_else(|constant| *constant, |column| column.interpolate_at(k, w));
        }
        inputs
    }
}

/// Returns an input of the law on a trial: time, its channel, the trial's constant depth, or the
/// law's default.
fn law_input<'a>(
    trial: &'a Trial,
    name: &str,
    default: Option<f64>,
    (lag_s, band): (f64, f64),
) -> Result<Result<MonotoneCubic<'a>, f64>, MissingChannel> {
    if name == TIME_INPUT {
        // Time counts from the first sample of the trial.
        let start = trial.t_s.first().copied().unwrap_or_default();
        return Ok(Ok(MonotoneCubic::new(
            &trial.t_s,
            trial.t_s.iter().map(|t| t - start).collect::<Vec<f64>>(),
        )));
    }
    let channel = input_channel(name);
    if let Some(column) = channel.and_then(|channel| trial.channel(channel)) {
        // The lag acts before the dead band.
        let late = (lag_s > 0.0).then(|| apply_lag(&trial.t_s, column, lag_s));
        let held = (band > 0.0).then(|| apply_dead_band(late.as_deref().unwrap_or(column), band));
        return Ok(Ok(match held.or(late) {
            Some(followed) => MonotoneCubic::new(&trial.t_s, followed),
            None => MonotoneCubic::new(&trial.t_s, column),
        }));
    }
    // Precedence: recorded channel, constant depth of the trial, default of the law.
    let constant =
        if channel == Some(Channel::Depth) { trial.depth_m.or(default) } else { default };
    match (constant, channel) {
        (Some(value), _) => Ok(Err(value)),
        (None, channel) => Err(MissingChannel {
            trial: trial.name.clone(),
            channel: channel.unwrap_or(Channel::Delta),
        }),
    }
}
