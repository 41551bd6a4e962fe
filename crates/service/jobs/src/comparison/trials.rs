//! Comparison of simulation errors on the same trials.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use utoipa::ToSchema;

use super::comparison_model::ComparisonModel;

/// Error of a model's simulation of a trial.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct TrialError {
    /// Root mean square errors by channel, SI; empty if the simulation stopped.
    pub rmse: BTreeMap<String, f64>,
    /// Sum of the squared errors of u, v, r, psi, x and y, each divided by the variance of the
    /// channel over the trials; null if the simulation stopped.
    pub standardised_mse: Option<f64>,
    /// Reason for a missing error: the trial lacks a channel, or the motion left the physical
    /// range.
    pub reason: Option<String>,
}

/// Errors of every model on one trial.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ComparedTrial {
    /// The trial.
    pub trial: String,
    /// Number of samples.
    pub samples: usize,
    /// Time from the first to the last sample, s.
    pub duration_s: f64,
    /// The error of each model.
    pub errors: Vec<TrialError>,
}

/// Simulates every model on every trial, once from the first sample.
pub fn simulation_errors(
    compared: &[ComparisonModel<'_>],
    ships: &[Ship],
    trials: &[(&str, &Trial)],
) -> Vec<ComparedTrial> {
    // One scale for each channel over all trials, so that errors of models are comparable.
    let deviations =
        standard_deviations(&trials.iter().map(|(_, trial)| *trial).collect::<Vec<_>>());
    let row = |(name, trial): &(&str, &Trial)| ComparedTrial {
        trial: (*name).to_owned(),
        samples: trial.t_s.len(),
        duration_s: trial.duration_s(),
        errors: compared
            .iter()
            .zip(ships)
            .map(|(one, ship)| simulation_error(one, ship, trial, &deviations))
            .collect(),
    };
    trials.iter().map(row).collect()
}

fn simulation_error(
    one: &ComparisonModel<'_>,
    ship: &Ship,
    trial: &Trial,
    deviations: &BTreeMap<Channel, f64>,
) -> TrialError {
    let none = |reason: String| TrialError {
        rmse: BTreeMap::new(),
        standardised_mse: None,
        reason: Some(reason),
    };
    match replay_trial(ship, trial, &ReplaySettings::default()) {
        Err(missing) => none(format!("{missing} by law `{}`", one.law.name)),
        Ok(run) => match &run.stopped {
            Some(stopped) => none(stopped.to_string()),
            None => {
                let error = SquaredError::from_trial(trial, &run);
                TrialError {
                    standardised_mse: Some(standardised_mse(&error, deviations)),
                    rmse: error.rmse_by_channel(),
                    reason: None,
                }
            }
        },
    }
}

/// Mean of a model's standardised squared error over all samples of all trials; `None` if one of
/// the simulations stopped or there are no samples.
pub fn mean_over_trials(trials: &[ComparedTrial], place: usize) -> Option<f64> {
    // Weighted by samples: sum_k(e_k n_k) / sum_k(n_k).
    let weighted = trials.iter().map(|trial| {
        Some((trial.errors[place].standardised_mse? * trial.samples as f64, trial.samples as f64))
    });
    let weighted: Option<Vec<(f64, f64)>> = weighted.collect();
    let (sum, samples) =
        weighted?.into_iter().fold((0.0, 0.0), |(sum, all), (value, n)| (sum + value, all + n));
    (samples > 0.0).then(|| sum / samples)
}
