//! Simulation of a recorded trial: the recorded rudder and revolutions drive the model, and the
//! simulated motion is compared with the recorded one.

mod instrument_correction;
mod part;
mod rates;
mod record;
mod replay_result;

use sistership_model::trial::Trial;
use sistership_model::trial_input::MissingInput;

use crate::integrate::Method;
use crate::lockstep;
use crate::ship::Ship;
pub use instrument_correction::correct_instrument_errors;
use part::TrialPart;
pub use rates::instants_along;
use record::TrialRecord;
pub use replay_result::TrialReplay;

/// Settings of the simulation of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplaySettings {
    /// Interval after which the simulation restarts from the recorded state, s; `None` simulates
    /// each gap-free part to its end.
    pub restart_s: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// Longest step, s; a sampling interval is divided into equal steps no longer than this.
    pub step_s: f64,
}

impl Default for ReplaySettings {
    fn default() -> Self {
        Self { restart_s: None, method: Method::Rk4, step_s: 0.5 }
    }
}

/// Trial to be simulated by one of several ships that differ in their coefficients alone.
#[derive(Debug, Clone, Copy)]
pub struct RecordedTrial<'a> {
    /// The trial.
    pub trial: &'a Trial,
    /// Coefficients of the ship, in the order of [`Ship::open_coefficients`]; empty for a ship
    /// without open coefficients.
    pub coefficients: &'a [f64],
}

/// Simulates a trial with its recorded inputs.
///
/// # Errors
/// Returns an error that names the channel that the trial lacks, velocities, rudder, or another
/// input of the law without a default, or the input that no trial can record.
pub fn replay_trial(
    ship: &Ship,
    trial: &Trial,
    settings: &ReplaySettings,
) -> Result<TrialReplay, MissingInput> {
    let mut all = replay_trials(ship, &[RecordedTrial { trial, coefficients: &[] }], settings)?;
    Ok(all.remove(0))
}

/// Simulates trials in lockstep, each as [`replay`] does.
///
/// # Errors
/// Returns the error of [`replay`] for the first trial that lacks a channel.
pub fn replay_trials(
    ship: &Ship,
    trials: &[RecordedTrial<'_>],
    settings: &ReplaySettings,
) -> Result<Vec<TrialReplay>, MissingInput> {
    let records = trials
        .iter()
        .map(|recorded| TrialRecord::new(ship, recorded.trial))
        .collect::<Result<Vec<_>, _>>()?;
    // Every part is a task of its own: lanes of a batch may hold parts of different trials.
    let mut passages: Vec<TrialPart<'_>> = Vec::new();
    for (index, (record, recorded)) in records.iter().zip(trials).enumerate() {
        let parts = simulation_parts(recorded.trial, settings.restart_s).into_iter();
        passages.extend(parts.map(|part| {
            TrialPart::new(index, record, recorded.coefficients, part, settings.step_s)
        }));
    }
    lockstep::run_batch(ship, settings.method, &mut passages);
    let nothing = || TrialReplay::without_samples(ship.has_roll());
    let mut replays: Vec<TrialReplay> = trials.iter().map(|_| nothing()).collect();
    passages.into_iter().for_each(|part| part.append_to_results(&mut replays));
    // Excursions are those of the whole trial, not of its parts.
    replays.iter_mut().for_each(|replay| replay.outside = ship.find_excursion(&replay.track));
    Ok(replays)
}

/// Returns the gap-free parts of a trial, divided where the simulation restarts.
fn simulation_parts(trial: &Trial, restart_s: Option<f64>) -> Vec<std::ops::Range<usize>> {
    let cut = |segment: std::ops::Range<usize>| {
        let mut starts = vec![segment.start];
        if let Some(restart) = restart_s {
            for k in segment.clone() {
                let since = trial.t_s[k] - trial.t_s[*starts.last().unwrap_or(&segment.start)];
                // The tolerance absorbs the rounding of recorded times.
                if since >= restart * (1.0 - 1e-9) {
                    starts.push(k);
                }
            }
        }
        starts.push(segment.end);
        starts.windows(2).map(|pair| pair[0]..pair[1]).collect::<Vec<_>>()
    };
    trial.segments().into_iter().flat_map(cut).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;
    use sistership_model::trial::Channel;

    use super::*;
    use crate::manoeuvre::{ManoeuvreSettings, simulate_zigzag};
    use crate::state::{RECORDED_CHANNELS, at};

    /// A zigzag of the Mariner, and its record.
    fn recorded() -> (Ship, Trial) {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
        let track =
            simulate_zigzag(&ship, 20.0, 20.0, &ManoeuvreSettings::default()).unwrap().track;
        let places = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
        let samples = |place: usize| track.states.iter().map(|state| state[place]).collect();
        let mut channels: std::collections::BTreeMap<_, _> =
            places.map(|&(channel, place)| (channel, samples(place))).collect();
        channels.insert(Channel::N, track.n_rps.clone());
        (ship, Trial { t_s: track.t_s, channels, ..Trial::default() })
    }

    fn heading_errors(replay: &TrialReplay, trial: &Trial) -> Vec<f64> {
        let psi = trial.channel(Channel::Psi).unwrap();
        let errors = replay.track.states.iter().zip(&replay.samples);
        errors.map(|(state, &k)| (state[at::PSI] - psi[k]).abs()).collect()
    }

    #[test]
    fn a_replay_is_the_motion_that_was_recorded() {
        let (ship, trial) = recorded();
        let replay = replay_trial(&ship, &trial, &ReplaySettings::default()).unwrap();
        assert!(replay.samples.iter().copied().eq(0..trial.len()), "{:?}", replay.stopped);
        assert_eq!(replay.track.t_s, trial.t_s);
        let largest = heading_errors(&replay, &trial).into_iter().fold(0.0, f64::max);
        assert!(largest < 2e-3, "{largest} rad");
    }

    /// A gyro that jumps by 0.1 rad is followed from the next restart on.
    #[test]
    fn a_restart_begins_from_the_recorded_state() {
        let (ship, mut trial) = recorded();
        let restart_s = Some(0.25 * trial.duration_s());
        let places: Vec<usize> =
            simulation_parts(&trial, restart_s).iter().map(|part| part.start).collect();
        assert_eq!((places.len(), places[0]), (4, 0), "{places:?}");
        let jump = places[2] - 7;
        trial.channels.get_mut(&Channel::Psi).unwrap()[jump..]
            .iter_mut()
            .for_each(|psi| *psi += 0.1);
        let settings = ReplaySettings { restart_s, ..ReplaySettings::default() };
        let errors = heading_errors(&replay_trial(&ship, &trial, &settings).unwrap(), &trial);
        assert_eq!(errors.len(), trial.len());
        let near = |part: std::ops::Range<usize>, exact: f64| {
            errors[part].iter().all(|error| (error - exact).abs() < 2e-3)
        };
        assert!(near(0..jump, 0.0) && near(jump..places[2], 0.1), "{errors:?}");
        assert!(near(places[2]..trial.len(), 0.0), "{errors:?}");
    }
}
