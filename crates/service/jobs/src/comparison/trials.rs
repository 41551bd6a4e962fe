//! Errors on the same trials side by side.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay};
use utoipa::ToSchema;

use super::compared::Compared;

/// How far a model's simulation of a trial is from what was measured.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct TrialError {
    /// Root mean square errors by channel, SI; empty where the simulation stopped.
    pub rmse: BTreeMap<String, f64>,
    /// The squared errors of u, v, r, psi, x and y by the variance of the channel over the trials,
    /// summed; null where the simulation stopped.
    pub standardised_mse: Option<f64>,
    /// Why there is no error: the trial lacks a channel, or the motion left the physical range.
    pub reason: Option<String>,
}

/// Errors of every model on one trial.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ComparedTrial {
    /// The trial.
    pub trial: String,
    /// How many samples it has.
    pub samples: usize,
    /// From the first to the last sample, s.
    pub duration_s: f64,
    /// The error of each model.
    pub errors: Vec<TrialError>,
}

/// Every model on every trial, each simulated once from the first sample.
pub fn errors(
    compared: &[Compared<'_>],
    ships: &[Ship],
    trials: &[(&str, &Trial)],
) -> Vec<ComparedTrial> {
    let deviations =
        standard_deviations(&trials.iter().map(|(_, trial)| *trial).collect::<Vec<_>>());
    let row = |(name, trial): &(&str, &Trial)| ComparedTrial {
        trial: (*name).to_owned(),
        samples: trial.t_s.len(),
        duration_s: trial.duration_s(),
        errors: compared
            .iter()
            .zip(ships)
            .map(|(one, ship)| error(one, ship, trial, &deviations))
            .collect(),
    };
    trials.iter().map(row).collect()
}

fn error(
    one: &Compared<'_>,
    ship: &Ship,
    trial: &Trial,
    deviations: &BTreeMap<Channel, f64>,
) -> TrialError {
    let none = |reason: String| TrialError {
        rmse: BTreeMap::new(),
        standardised_mse: None,
        reason: Some(reason),
    };
    match replay(ship, trial, &ReplaySettings::default()) {
        Err(missing) => none(format!("{missing} by law `{}`", one.law.name)),
        Ok(run) => match &run.stopped {
            Some(stopped) => none(stopped.to_string()),
            None => {
                let error = SquaredError::of(trial, &run);
                TrialError {
                    standardised_mse: Some(standardised_mse(&error, deviations)),
                    rmse: error.rmse(),
                    reason: None,
                }
            }
        },
    }
}

/// The mean over all samples of all trials of a model's standardised squared error.
pub fn over_all(trials: &[ComparedTrial], place: usize) -> Option<f64> {
    let weighted = trials.iter().map(|trial| {
        Some((trial.errors[place].standardised_mse? * trial.samples as f64, trial.samples as f64))
    });
    let weighted: Option<Vec<(f64, f64)>> = weighted.collect();
    let (sum, samples) =
        weighted?.into_iter().fold((0.0, 0.0), |(sum, all), (value, n)| (sum + value, all + n));
    (samples > 0.0).then(|| sum / samples)
}
