//! How a model does on trials that no call saw.

use sistership_model::Model;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::error::{SquaredError, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::{Ship, StateVector};

use crate::data::DataSet;

/// Channels whose errors are standardised and averaged: u, v, r, heading, position.
const CHANNELS: f64 = 6.0;

/// Errors over all unseen trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Standardised mean squared error, mean over u, v, r, psi, x, y.
    pub error: f64,
    /// The same over every second trial, from the first and from the second on.
    pub halves: [f64; 2],
    /// Root mean square of the heading, deg.
    pub heading_deg: f64,
}

/// Errors of a model.
///
/// # Errors
/// It cannot sail: the reason.
pub fn judge(model: &Model, data: &DataSet) -> Result<Judged, String> {
    let each = trial_errors(model, data)?;
    let error = |sum: &SquaredError| standardised_mse(sum, &data.deviations) / CHANNELS;
    let sum = summed(&each);
    let heading = sum.channel_rmse(Channel::Psi).unwrap_or(f64::NAN);
    let halves = [0, 1].map(|first| error(&summed(each.iter().skip(first).step_by(2))));
    Ok(Judged { error: error(&sum), halves, heading_deg: heading.to_degrees() })
}

/// Sums of squares over the unseen trials.
///
/// # Errors
/// As [`judge`].
pub fn errors(model: &Model, data: &DataSet) -> Result<SquaredError, String> {
    Ok(summed(&trial_errors(model, data)?))
}

fn summed<'a>(errors: impl IntoIterator<Item = &'a SquaredError>) -> SquaredError {
    let mut sum = SquaredError::default();
    errors.into_iter().for_each(|error| sum.add(error));
    sum
}

fn trial_errors(model: &Model, data: &DataSet) -> Result<Vec<SquaredError>, String> {
    let law = data.zoo.law(&model.law).ok_or_else(|| format!("no law `{}`", model.law))?;
    let mut ship = Ship::new(model, law).map_err(|error| error.to_string())?;
    ship.set_envelope_speed(data.unseen.iter().map(fastest).fold(0.0, f64::max));
    let settings = ReplaySettings { restart_s: Some(data.restart_s), ..ReplaySettings::default() };
    let errors = data.unseen.iter().map(|trial| {
        let run = replay_trial(&ship, trial, &settings).map_err(|error| error.to_string())?;
        if let Some(stopped) = run.stopped {
            return Err(format!("{}: {stopped}", trial.name));
        }
        if !run.track.states.iter().all(|state: &StateVector| state.iter().all(|x| x.is_finite())) {
            return Err(format!("{}: not a number", trial.name));
        }
        Ok(SquaredError::from_trial(trial, &run))
    });
    errors.collect()
}

fn fastest(trial: &Trial) -> f64 {
    trial.channel(Channel::U).into_iter().flatten().fold(0.0, |most: f64, u| most.max(u.abs()))
}
