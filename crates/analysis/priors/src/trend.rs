//! Whether a model captures the trend of trials.

use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{FileError, Model};
use sistership_simulation::recorded::{MissingChannel, Recorded, ReplaySettings, replay_all};
use sistership_simulation::state::at;
use sistership_simulation::{PlantError, Stopped};

use crate::transfer::ready;

/// Trials that are simulated in lockstep; more would be in vain where the first does not sail.
const TOGETHER: usize = 8;

/// Why it cannot be told whether a model captures the trend of trials.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrendError {
    /// The model's law is not known.
    #[error("there is no law `{0}`")]
    NoLaw(String),
    /// The source's file is at fault.
    #[error(transparent)]
    File(#[from] FileError),
    /// The law rolls, and a trial does not record how.
    #[error("its law has roll, and trial `{trial}` has no channel `{channel}`")]
    Roll {
        /// The trial.
        trial: String,
        /// The channel.
        channel: Channel,
    },
    /// The model cannot be made ready.
    #[error(transparent)]
    Model(#[from] PlantError),
    /// A trial lacks a channel.
    #[error(transparent)]
    Trial(#[from] MissingChannel),
    /// The simulation left the physical range.
    #[error("{trial} {stopped}")]
    Stopped {
        /// The trial.
        trial: String,
        /// When and why.
        stopped: Stopped,
    },
    /// Nothing turns.
    #[error("the yaw rate is constant")]
    Constant,
}

/// How well a model captures the trend of trials: Pearson's correlation of simulated and measured
/// yaw rate over all of them, simulated with the recorded rudder and started anew every
/// `restart_s`.
///
/// # Errors
/// Says which channel is missing, or that the simulation left the physical range.
pub fn trend(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    restart_s: f64,
) -> Result<f64, TrendError> {
    let ship = ready(model, law, trials)?;
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let mut pairs = Vec::new();
    for together in trials.chunks(TOGETHER) {
        let recorded = together.iter().map(|trial| Recorded { trial, coefficients: &[] });
        let runs = replay_all(&ship, &recorded.collect::<Vec<_>>(), &settings)?;
        for (trial, run) in together.iter().zip(runs) {
            if let Some(stopped) = run.stopped {
                return Err(TrendError::Stopped { trial: trial.name.clone(), stopped });
            }
            let measured = trial.channel(Channel::R).unwrap_or_default();
            let states = run.track.states.iter().zip(&run.samples);
            pairs.extend(states.map(|(state, &k)| (state[at::R], measured[k])));
        }
    }
    pearson(&pairs).ok_or(TrendError::Constant)
}

fn pearson(pairs: &[(f64, f64)]) -> Option<f64> {
    let n = pairs.len() as f64;
    let mean = pairs.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let sums = pairs.iter().fold((0.0, 0.0, 0.0), |s, p| {
        let (a, b) = (p.0 - mean.0, p.1 - mean.1);
        (s.0 + a * a, s.1 + b * b, s.2 + a * b)
    });
    let spread = (sums.0 * sums.1).sqrt();
    (spread > 0.0).then(|| sums.2 / spread)
}
