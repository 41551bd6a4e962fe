//! Recorded motion along which a model is linearised.

use sistership_model::trial::Channel;
use sistership_simulation::instruments::THROUGH_WATER;
use sistership_simulation::state::at;
use sistership_simulation::tape::{LaneValues, TapeResults};

use super::followed::FollowedInput;
use super::lanes::{LANES, fill_lanes};
use super::record::smooth_parabolic;
use super::{ResidualSystem, TrialReadings};
use sistership_identification::refine::RefineError;

/// Recorded motion and inputs over the samples of a trial.
pub(super) struct RecordedPath<'a> {
    pub record: &'a TrialReadings<'a>,
    /// Smooth path of each state of the filter.
    pub states: Vec<Vec<f64>>,
    /// Readings of the instruments, by channel of the system; absent where nothing was recorded.
    pub said: Vec<Option<&'a [f64]>>,
    pub inputs: Vec<Vec<f64>>,
    /// For each parameter that acts on the response to an input: the input with a slightly (or
    /// first) larger figure, and the increment.
    pub followed: Vec<Option<(Vec<f64>, f64)>>,
}

impl<'a> RecordedPath<'a> {
    pub fn new(
        system: &ResidualSystem,
        record: &'a TrialReadings<'a>,
    ) -> Result<Self, RefineError> {
        for channel in [Channel::U, Channel::V, Channel::R] {
            record.required_channel(channel)?;
        }
        if system.axes.len() > 3 {
            record.required_channel(Channel::Phi)?;
            record.required_channel(Channel::P)?;
        }
        let said: Vec<Option<&[f64]>> =
            system.channels.iter().map(|&(channel, _)| record.trial.channel(channel)).collect();
        let mut states = vec![vec![0.0; record.trial.len()]; system.state_count()];
        for (&(channel, place), said) in system.channels.iter().zip(&said) {
            // Logs through the water read no state of the path, so only state channels are
            // smoothed.
            if let Some(said) = said.filter(|_| is_state(channel)) {
                states[place] = smooth_parabolic(said);
            }
        }
        let mut inputs = Vec::new();
        for (name, default) in &system.inputs {
            inputs.push(record.input(name, *default)?);
        }
        // Before the path is corrected: the instruments take inputs with lags and dead bands
        // applied.
        let followed = follow_inputs(system, record, &mut inputs);
        let mut path = Self { record, states, said, inputs, followed };
        path.correct_path(system);
        Ok(path)
    }

    /// Removes from the path the deviation of the readings from the states, so that the model is
    /// linearised along the ship's motion.
    fn correct_path(&mut self, system: &ResidualSystem) {
        if system.says.is_empty() {
            return;
        }
        let t_s = &self.record.trial.t_s;
        // All rates come from the path before any correction, so that blocks do not depend on each
        // other.
        let smooth = self.states.clone();
        let mut work = TapeResults::default();
        for first in (0..t_s.len()).step_by(LANES) {
            // Lanes beyond the last sample repeat it.
            let samples = std::array::from_fn(|k| (first + k).min(t_s.len() - 1));
            let slopes =
                |state: usize| fill_lanes(|k| central_difference(t_s, &smooth[state], samples[k]));
            let inputs = self.instrument_inputs(system, &samples, &slopes);
            system.instruments.evaluate(&inputs, &mut work);
            let moves = |channel: usize| {
                self.said[channel].is_some() && is_state(system.channels[channel].0)
            };
            let moving: Vec<(usize, usize)> =
                system.says.iter().copied().enumerate().filter(|&(_, c)| moves(c)).collect();
            for (output, channel) in moving {
                let state = system.channels[channel].1;
                let says = system.instruments.output_lanes(output, &work);
                let here = inputs[instrument_state_index(system.states[state])];
                for (k, value) in self.states[state].iter_mut().skip(first).take(LANES).enumerate()
                {
                    // Reading less state, both on the smooth path.
                    *value -= says[k] - here[k];
                }
            }
        }
    }

    pub fn instrument_inputs(
        &self,
        system: &ResidualSystem,
        samples: &[usize; LANES],
        rate: &dyn Fn(usize) -> LaneValues<LANES>,
    ) -> Vec<LaneValues<LANES>> {
        let of = |values: &[f64]| fill_lanes(|k| values[samples[k]]);
        let by_place = |values: &dyn Fn(usize) -> LaneValues<LANES>| {
            let state = |place: usize| system.states.iter().position(|&state| state == place);
            INSTRUMENTS.map(|place| state(place).map_or([0.0; LANES], values))
        };
        let mut inputs = by_place(&|state| of(&self.states[state])).to_vec();
        inputs.extend(by_place(rate));
        inputs.extend(self.inputs.iter().map(|input| of(input)));
        inputs.extend(system.parameter_values().map(|value| [value; LANES]));
        inputs
    }
}

/// States in the order in which instruments take them, followed by their rates.
const INSTRUMENTS: [usize; 8] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];

pub(super) fn instrument_state_index(place: usize) -> usize {
    INSTRUMENTS.iter().position(|&known| known == place).unwrap_or(0)
}

pub(super) fn instrument_rate_index(place: usize) -> usize {
    INSTRUMENTS.len() + instrument_state_index(place)
}

/// Returns true if the path follows a channel; a log through the water measures the same state as
/// another channel.
fn is_state(channel: Channel) -> bool {
    THROUGH_WATER.iter().all(|&(log, _)| log != channel)
}

/// Central differences; one-sided at the ends.
fn central_difference(t_s: &[f64], values: &[f64], k: usize) -> f64 {
    let (before, after) = (k.saturating_sub(1), (k + 1).min(values.len() - 1));
    (values[after] - values[before]) / (t_s[after] - t_s[before]).max(1e-9)
}

impl<'a> RecordedPath<'a> {
    /// Recorded roll for a law without roll, if it was recorded.
    pub fn recorded_roll(&self, name: &str) -> Option<&'a [f64]> {
        let trial = self.record.trial;
        Channel::by_name(name).and_then(|channel| trial.channel(channel))
    }
}

/// Applies lags and dead bands to the inputs and prepares their derivatives.
fn follow_inputs(
    system: &ResidualSystem,
    record: &TrialReadings<'_>,
    inputs: &mut [Vec<f64>],
) -> Vec<Option<(Vec<f64>, f64)>> {
    let t_s = &record.trial.t_s;
    let parameters = system
        .columns
        .candidates
        .iter()
        .flat_map(|c| c.at.iter().copied().zip(c.form.parameters.values()));
    let mut derivatives = Vec::new();
    for ((value, parameter), followed) in parameters.zip(&system.followed) {
        let Some(FollowedInput { input, way }) = *followed else {
            derivatives.push(None);
            continue;
        };
        let more = way.derivative_step(value, parameter.start);
        // The increment is taken from the record before the input is replaced by its lagged value.
        let larger = way.followed_input(t_s, &inputs[input], value + more);
        if value > 0.0 {
            inputs[input] = way.followed_input(t_s, &inputs[input], value);
        }
        derivatives.push(Some((larger, more)));
    }
    derivatives
}
