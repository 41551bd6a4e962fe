//! The tracks that a foundation draws ahead from each of some samples of a trial.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::recorded::{Recorded, ReplaySettings, replay_all};
use sistership_simulation::state::StateVector;

use super::error::HorizonError;

/// The states one to so many samples after each of the given ones, under the recorded orders and
/// the wind of the instant of the prediction: nobody knows that of later.
///
/// # Errors
/// Names the channel that the trial lacks, or the sample from which the foundation cannot sail.
pub fn ahead(
    ship: &Ship,
    trial: &Trial,
    starts: &[usize],
    steps: usize,
) -> Result<Vec<Vec<StateVector>>, HorizonError> {
    let parts: Vec<Trial> = starts.iter().map(|k| part(trial, *k, steps)).collect();
    let recorded: Vec<Recorded<'_>> =
        parts.iter().map(|trial| Recorded { trial, coefficients: &[] }).collect();
    let replays = replay_all(ship, &recorded, &ReplaySettings::default())?;
    let of = |(replay, k): (sistership_simulation::recorded::Replay, &usize)| {
        let (trial, t_s) = (trial.name.clone(), trial.t_s[*k]);
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

/// A part of a trial in which the wind is that of its first sample.
fn part(trial: &Trial, start: usize, steps: usize) -> Trial {
    let own = start..=start + steps;
    let wind = [
        Channel::WindSpeed,
        Channel::WindFrom,
        Channel::ApparentWindSpeed,
        Channel::ApparentWindFrom,
    ];
    let of = |(channel, column): (&Channel, &Vec<f64>)| {
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
