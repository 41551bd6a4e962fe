//! Simulation of a recorded trial: the recorded rudder and revolutions drive the model, and the motion is compared.

mod part;
mod truth;

use sistership_model::effect::{TIME, input_channel};
use sistership_model::trial::{Channel, Trial};
use sistership_model::validity::Excursion;

use crate::envelope::Stopped;
use crate::integrate::Method;
use crate::interpolate::{MonotoneCubic, lagged};
use crate::lockstep;
use crate::plant::{Inputs, MAX_INPUTS};
use crate::ship::Ship;
use crate::state::{RECORDED, StateVector, Trajectory, at};
use part::Part;
pub use truth::as_true_instruments_say;

/// How a trial is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplaySettings {
    /// Start anew from the recorded state every so often, s; `None` runs each gap-free part to its end.
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

/// Why a trial cannot be simulated at all.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("trial `{trial}` has no channel `{channel}`, which the simulation needs")]
pub struct MissingChannel {
    /// The trial.
    pub trial: String,
    /// The channel it lacks.
    pub channel: Channel,
}

/// A simulated trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Simulated states at the recorded times, as the instruments would say them; after a divergence, until then only.
    pub track: Trajectory,
    /// Sample of the trial to which each state belongs.
    pub samples: Vec<usize>,
    /// Why the simulation stopped early, if it did.
    pub stopped: Option<Stopped>,
    /// Whether roll was simulated.
    pub has_roll: bool,
    /// How the motion left what the model's trials covered, if it did.
    pub outside: Option<Excursion>,
}

/// A trial to be simulated by one of some ships that differ in their coefficients alone.
#[derive(Debug, Clone, Copy)]
pub struct Recorded<'a> {
    /// The trial.
    pub trial: &'a Trial,
    /// The ship's coefficients, in the order of [`Ship::open_coefficients`]; none for a ship with her own.
    pub coefficients: &'a [f64],
}

/// Simulates a trial with its recorded inputs.
///
/// # Errors
/// Names the channel that the trial lacks: velocities, rudder, or another input of the law that has no default.
pub fn replay(ship: &Ship, trial: &Trial, settings: &ReplaySettings) -> Result<Replay, MissingChannel> {
    let mut all = replay_all(ship, &[Recorded { trial, coefficients: &[] }], settings)?;
    Ok(all.remove(0))
}

/// Simulates trials in lockstep, each as [`replay`] would.
///
/// # Errors
/// As [`replay`], of the first trial that lacks something.
pub fn replay_all(ship: &Ship, trials: &[Recorded<'_>], settings: &ReplaySettings) -> Result<Vec<Replay>, MissingChannel> {
    let records = trials.iter().map(|recorded| Record::new(ship, recorded.trial)).collect::<Result<Vec<_>, _>>()?;
    let mut passages: Vec<Part<'_>> = Vec::new();
    for (index, (record, recorded)) in records.iter().zip(trials).enumerate() {
        let parts = parts(recorded.trial, settings.restart_s).into_iter();
        passages.extend(parts.map(|part| Part::new(index, record, recorded.coefficients, part, settings.step_s)));
    }
    lockstep::sail(ship, settings.method, &mut passages);
    let nothing = || Replay::nothing(ship.has_roll());
    let mut replays: Vec<Replay> = trials.iter().map(|_| nothing()).collect();
    passages.into_iter().for_each(|part| part.join(&mut replays));
    replays.iter_mut().for_each(|replay| replay.outside = ship.leaves(&replay.track));
    Ok(replays)
}

impl Replay {
    fn nothing(has_roll: bool) -> Self {
        Self { track: Trajectory::default(), samples: Vec::new(), stopped: None, has_roll, outside: None }
    }
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

/// The channels of a trial that a simulation reads.
struct Record<'a> {
    trial: &'a Trial,
    delta: &'a [f64],
    n: Option<&'a [f64]>,
    /// Each input of the law: recorded, or constant.
    inputs: Vec<Result<MonotoneCubic<'a>, f64>>,
    start: Vec<(usize, &'a [f64])>,
}

impl<'a> Record<'a> {
    fn new(ship: &Ship, trial: &'a Trial) -> Result<Self, MissingChannel> {
        let need = |channel| trial.channel(channel).ok_or_else(|| MissingChannel { trial: trial.name.clone(), channel });
        // Velocities must be known at the start of a part; heading and position start at zero where they are not.
        for (channel, _) in &RECORDED[..3] {
            need(*channel)?;
        }
        let start = RECORDED.iter().filter_map(|&(channel, index)| Some((index, trial.channel(channel)?))).collect();
        let lag_s = |place: usize| ship.lags_s().iter().find(|(of, _)| *of == place).map(|&(_, lag_s)| lag_s);
        let inputs = ship.law_inputs().enumerate();
        let inputs =
            inputs.map(|(place, (name, default))| input(trial, name, default, lag_s(place))).collect::<Result<_, _>>()?;
        Ok(Self { trial, delta: need(Channel::Delta)?, n: trial.channel(Channel::N), inputs, start })
    }

    fn state_at(&self, sample: usize) -> StateVector {
        let mut state = StateVector::zeros();
        self.start.iter().for_each(|(index, column)| state[*index] = column[sample]);
        state[at::DELTA] = self.delta[sample];
        state
    }

    /// The inputs at a fraction of the way from a sample to the next.
    fn inputs_at(&self, k: usize, w: f64) -> Inputs {
        let mut inputs = [0.0; MAX_INPUTS];
        for (value, input) in inputs.iter_mut().zip(&self.inputs) {
            *value = input.as_ref().map_or_else(|constant| *constant, |column| column.at(k, w));
        }
        inputs
    }
}

/// An input of the law on a trial: time, its channel, the trial's constant depth, or the law's default.
fn input<'a>(
    trial: &'a Trial,
    name: &str,
    default: Option<f64>,
    lag_s: Option<f64>,
) -> Result<Result<MonotoneCubic<'a>, f64>, MissingChannel> {
    if name == TIME {
        let start = trial.t_s.first().copied().unwrap_or_default();
        return Ok(Ok(MonotoneCubic::new(&trial.t_s, trial.t_s.iter().map(|t| t - start).collect::<Vec<f64>>())));
    }
    let channel = input_channel(name);
    if let Some(column) = channel.and_then(|channel| trial.channel(channel)) {
        return Ok(Ok(match lag_s {
            Some(lag_s) if lag_s > 0.0 => MonotoneCubic::new(&trial.t_s, lagged(&trial.t_s, column, lag_s)),
            _ => MonotoneCubic::new(&trial.t_s, column),
        }));
    }
    let constant = if channel == Some(Channel::Depth) { trial.depth_m.or(default) } else { default };
    match (constant, channel) {
        (Some(value), _) => Ok(Err(value)),
        (None, channel) => Err(MissingChannel { trial: trial.name.clone(), channel: channel.unwrap_or(Channel::Delta) }),
    }
}
