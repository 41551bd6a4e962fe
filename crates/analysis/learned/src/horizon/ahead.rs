//! Tracks that a foundation predicts from samples of a trial.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, replay_trials};
use sistership_simulation::state::StateVector;

use super::error::HorizonError;

/// Returns the states at the next `steps` samples after each of the given ones, under the recorded
/// orders and the wind at the instant of the prediction: later wind is not known then.
///
/// # Errors
/// Returns an error that names the missing channel, or the sample from which the foundation cannot
/// be simulated.
pub fn predict_tracks(
    ship: &Ship,
    trial: &Trial,
    starts: &[usize],
    steps: usize,
) -> Result<Vec<Vec<StateVector>>, HorizonError> {
    let parts: Vec<Trial> = starts.iter().map(|k| constant_wind_part(trial, *k, steps)).collect();
    let recorded: Vec<RecordedTrial<'_>> =
        parts.iter().map(|trial| RecordedTrial { trial, coefficients: &[] }).collect();
    let replays = replay_trials(ship, &recorded, &ReplaySettings::default())?;
    let of = |(replay, k): (sistership_simulation::recorded::TrialReplay, &usize)| {
        let (trial, t_s) = (trial.name.clone(), trial.t_s[*k]);
        // A track that ends early gives no example.
        if replay.stopped.is_some() || replay.track.states.len() != steps + 1 {
            return Err(HorizonError::Stopped { trial, t_s });
        }
        if replay.track.states.iter().any(|state| state.iter().any(|value| !value.is_finite())) {
            return Err(HorizonError::NotANumber { trial, t_s });
        }
        Ok(replay.track.states[1..].to_vec())
    };
    replays.into_iter().zip(starts).map(of).collect()
}

/// Part of a trial with the wind of its first sample throughout.
fn constant_wind_part(trial: &Trial, start: usize, steps: usize) -> Trial {
    let own = start..=start + steps;
    let wind = [
        Channel::WindSpeed,
        Channel::WindFrom,
        Channel::ApparentWindSpeed,
        Channel::ApparentWindFrom,
    ];
    let of = |(channel, column): (&Channel, &Vec<f64>)| {
        // Later wind is unknown at the instant of the prediction; the orders are known.
        let kept = if wind.contains(channel) {
            vec![column[start]; steps + 1]
        } else {
            column[own.clone()].to_vec()
        };
        (*channel, kept)
    };
    Trial {
        name: trial.name.clone(),
        t_s: trial.t_s[own.clone()].to_vec(),
        channels: trial.channels.iter().map(of).collect(),
        depth_m: trial.depth_m,
        velocity: trial.velocity,
        ..Trial::default()
    }
}
