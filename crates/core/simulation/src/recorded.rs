//! Simulation of a recorded trial: the recorded rudder and revolutions drive the model, and the
//! motion is compared.

mod part;
mod rates;
mod record;
mod replayed;
mod truth;

use sistership_model::trial::Trial;

use crate::integrate::Method;
use crate::lockstep;
use crate::ship::Ship;
use part::Part;
pub use rates::instants_along;
pub use record::MissingChannel;
use record::Record;
pub use replayed::Replay;
pub use truth::as_true_instruments_say;

/// How a trial is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplaySettings {
    /// Start anew from the recorded state every so often, s; `None` runs each gap-free part to its
    /// end.
    pub restart_s: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// Longest step, s; a sampling interval is cut into equal steps no longer than this.
    pub step_s: f64,
}

impl Default for ReplaySettings {
    fn default() -> Self {
        Self { restart_s: None, method: Method::Rk4, step_s: 0.5 }
    }
}

/// A trial to be simulated by one of some ships that differ in their coefficients alone.
#[derive(Debug, Clone, Copy)]
pub struct Recorded<'a> {
    /// The trial.
    pub trial: &'a Trial,
    /// The ship's coefficients, in the order of [`Ship::open_coefficients`]; none for a ship with
    /// its own.
    pub coefficients: &'a [f64],
}

/// Simulates a trial with its recorded inputs.
///
/// # Errors
/// Names the channel that the trial lacks: velocities, rudder, or another input of the law that has
/// no default.
pub fn replay(
    ship: &Ship,
    trial: &Trial,
    settings: &ReplaySettings,
) -> Result<Replay, MissingChannel> {
    let mut all = replay_all(ship, &[Recorded { trial, coefficients: &[] }], settings)?;
    Ok(all.remove(0))
}

/// Simulates trials in lockstep, each as [`replay`] would.
///
/// # Errors
/// As [`replay`], of the first trial that lacks something.
pub fn replay_all(
    ship: &Ship,
    trials: &[Recorded<'_>],
    settings: &ReplaySettings,
) -> Result<Vec<Replay>, MissingChannel> {
    let records = trials
        .iter()
        .map(|recorded| Record::new(ship, recorded.trial))
        .collect::<Result<Vec<_>, _>>()?;
    let mut passages: Vec<Part<'_>> = Vec::new();
    for (index, (record, recorded)) in records.iter().zip(trials).enumerate() {
        let parts = parts(recorded.trial, settings.restart_s).into_iter();
        passages
            .extend(parts.map(|part| {
                Part::new(index, record, recorded.coefficients, part, settings.step_s)
            }));
    }
    lockstep::sail(ship, settings.method, &mut passages);
    let nothing = || Replay::nothing(ship.has_roll());
    let mut replays: Vec<Replay> = trials.iter().map(|_| nothing()).collect();
    passages.into_iter().for_each(|part| part.join(&mut replays));
    replays.iter_mut().for_each(|replay| replay.outside = ship.leaves(&replay.track));
    Ok(replays)
}

/// The gap-free parts of a trial, cut where the simulation starts anew.
fn parts(trial: &Trial, restart_s: Option<f64>) -> Vec<std::ops::Range<usize>> {
    let cut = |segment: std::ops::Range<usize>| {
        let mut starts = vec![segment.start];
        if let Some(restart) = restart_s {
            for k in segment.clone() {
                let since = trial.t_s[k] - trial.t_s[*starts.last().unwrap_or(&segment.start)];
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
