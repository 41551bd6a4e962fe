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
