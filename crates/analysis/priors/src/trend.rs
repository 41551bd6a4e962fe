//! Trend of trials captured by a model.

use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::trial_input::MissingInput;
use sistership_model::{FileError, Model};
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, replay_trials};
use sistership_simulation::state::at;
use sistership_simulation::{PlantError, SimulationStop};

use crate::transfer::prepare_ship;

/// Number of trials that are simulated in lockstep; more would be wasted where the first one fails.
const BATCH_SIZE: usize = 8;

/// Error of the trend of trials.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrendError {
    /// The model's law is unknown.
    #[error("the law `{0}` is not in the zoo")]
    NoLaw(String),
    /// The source's file is invalid.
    #[error(transparent)]
    File(#[from] FileError),
    /// The law has roll, and a trial does not record it.
    #[error("its law has roll, but trial `{trial}` has no channel `{channel}`")]
    Roll {
        /// The trial.
        trial: String,
        /// The channel.
        channel: Channel,
    },
    /// The model cannot be prepared for simulation.
    #[error(transparent)]
    Model(#[from] PlantError),
    /// A trial lacks a channel, or cannot record an input of the law.
    #[error(transparent)]
    Trial(#[from] MissingInput),
    /// The simulation left the physical range.
    #[error("{trial} {stopped}")]
    Stopped {
        /// The trial.
        trial: String,
        /// Time and reason of the stop.
        stopped: SimulationStop,
    },
    /// The yaw rate does not vary.
    #[error("the yaw rate is constant")]
    Constant,
}

/// Returns Pearson's correlation of simulated and measured yaw rate over all trials, simulated with
/// the recorded rudder and restarted every `restart_s`.
///
/// # Errors
/// Returns an error that names a missing channel, or one if the simulation left the physical range.
pub fn trend_correlation(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    restart_s: f64,
) -> Result<f64, TrendError> {
    let ship = prepare_ship(model, law, trials)?;
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let mut pairs = Vec::new();
    for together in trials.chunks(BATCH_SIZE) {
        let recorded = together.iter().map(|trial| RecordedTrial { trial, coefficients: &[] });
        let runs = replay_trials(&ship, &recorded.collect::<Vec<_>>(), &settings)?;
        for (trial, run) in together.iter().zip(runs) {
            if let Some(stopped) = run.stopped {
                return Err(TrendError::Stopped { trial: trial.name.clone(), stopped });
            }
            let measured = trial.channel(Channel::R).unwrap_or_default();
            // Only the samples of the simulation are compared, by the indices of the run.
            let states = run.track.states.iter().zip(&run.samples);
            pairs.extend(states.map(|(state, &k)| (state[at::R], measured[k])));
        }
    }
    pearson_correlation(&pairs).ok_or(TrendError::Constant)
}

fn pearson_correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let n = pairs.len() as f64;
    let mean = pairs.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let sums = pairs.iter().fold((0.0, 0.0, 0.0), |s, p| {
        let (a, b) = (p.0 - mean.0, p.1 - mean.1);
        (s.0 + a * a, s.1 + b * b, s.2 + a * b)
    });
    let spread = (sums.0 * sums.1).sqrt();
    (spread > 0.0).then(|| sums.2 / spread)
}
