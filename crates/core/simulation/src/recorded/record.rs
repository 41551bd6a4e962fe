//! Channels of a trial in the form that a simulation reads.

use std::borrow::Cow;

use sistership_model::trial::{Channel, Trial};
use sistership_model::trial_input::{MissingInput, TrialInput, find_input};

use crate::interpolate::{MonotoneCubic, apply_dead_band, apply_lag};
use crate::plant::{LawInputs, MAX_INPUTS};
use crate::ship::Ship;
use crate::state::{RECORDED_CHANNELS, StateVector, at};

/// Channels of a trial that a simulation reads.
pub struct TrialRecord<'a> {
    pub trial: &'a Trial,
    /// Recorded rudder angle; zero for a ship that none steers.
    pub delta: Cow<'a, [f64]>,
    pub n: Option<&'a [f64]>,
    /// Each input of the law: recorded, or a constant.
    inputs: Vec<Result<MonotoneCubic<'a>, f64>>,
    start: Vec<(usize, &'a [f64])>,
}

impl<'a> TrialRecord<'a> {
    pub fn new(ship: &Ship, trial: &'a Trial) -> Result<Self, MissingInput> {
        let need = |channel| {
            trial
                .channel(channel)
                .ok_or_else(|| MissingInput::Channel { trial: trial.name.clone(), channel })
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
        let delta = match trial.channel(Channel::Delta) {
            Some(delta) => Cow::Borrowed(delta),
            None if ship.has_rudder() => Cow::Borrowed(need(Channel::Delta)?),
            None => Cow::Owned(vec![0.0; trial.len()]),
        };
        Ok(Self { trial, delta, n: trial.channel(Channel::N), inputs, start })
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

/// Returns an input of the law on a trial as the ship follows it: samples after its lag and dead
/// band, or a constant.
fn law_input<'a>(
    trial: &'a Trial,
    name: &str,
    default: Option<f64>,
    (lag_s, band): (f64, f64),
) -> Result<Result<MonotoneCubic<'a>, f64>, MissingInput> {
    let column = match find_input(trial, name, default)? {
        TrialInput::Samples(column) => column,
        TrialInput::Constant(value) => return Ok(Err(value)),
    };
    // The lag acts before the dead band.
    let late = (lag_s > 0.0).then(|| apply_lag(&trial.t_s, &column, lag_s));
    let held = (band > 0.0).then(|| apply_dead_band(late.as_deref().unwrap_or(&column), band));
    Ok(Ok(match held.or(late) {
        Some(followed) => MonotoneCubic::new(&trial.t_s, followed),
        None => MonotoneCubic::new(&trial.t_s, column),
    }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_formula::units::Dimension;
    use sistership_model::Zoo;
    use sistership_model::law::LawInput;

    use super::*;

    #[test]
    fn an_input_that_no_trial_can_record_is_not_reported_as_the_rudder() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let mut law = zoo.law(&model.law).unwrap().as_ref().clone();
        law.inputs.insert(
            "ballast".into(),
            LawInput { dimension: Dimension::NONE, default: None, helm: None },
        );
        let ship = Ship::new(&model, &law).unwrap();
        let mut trial = Trial { t_s: vec![0.0, 1.0], ..Trial::default() };
        for channel in Channel::all_channels() {
            trial.channels.insert(channel, vec![0.0; 2]);
        }
        let missing = TrialRecord::new(&ship, &trial).err();
        assert_eq!(missing, Some(MissingInput::Unrecordable("ballast".into())));
    }
}
