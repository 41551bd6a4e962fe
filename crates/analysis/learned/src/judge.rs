//! Evaluation of learned corrections: simulations of held-out trials by the foundation, with and
//! without the correction.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations};
use sistership_simulation::horizons::{HorizonErrors, combine_horizons};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::held_out::{HeldOutFold, HeldOutTrials};
use crate::train::{CorrectionTraining, TrainError};

/// Ship lengths between restarts of a simulation; each trial is also simulated as a whole, and the
/// error is the geometric mean of both.
const RESTART_LENGTHS: f64 = 10.0;

/// Evaluation of a correction on held-out trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CorrectionEvaluation {
    /// Each trial, by a correction that was trained without it.
    pub trials: Vec<TrialEvaluation>,
    /// Standardised mean squared error of the foundation, mean over the trials.
    pub foundation: f64,
    /// The same with the correction.
    pub branch: f64,
    /// Standard error of the difference of the two over the trials; absent for a single trial, which
    /// has no scatter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// Mean share of the correction over these simulations, 0 to 1.
    pub share: f64,
}

/// Evaluation of one held-out trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialEvaluation {
    /// Name of the trial.
    pub name: String,
    /// Error of the foundation.
    pub foundation: TrialError,
    /// Error with the correction.
    pub branch: TrialError,
    /// Mean share of the correction over the simulation, 0 to 1.
    pub share: f64,
}

/// Errors of a simulation of a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialError {
    /// Root mean squared errors by channel, SI units.
    pub rmse: BTreeMap<String, f64>,
    /// Standardised mean squared error (Wakita 2022, Eq. 26), the geometric mean of simulations
    /// that restart every ten ship lengths and of the whole trial; samples that are not simulated
    /// because a simulation stopped count like an unrelated motion.
    pub standardised_mse: f64,
    /// Reason why the simulation stopped early, if it did; the root mean squared errors are up to
    /// then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

impl CorrectionEvaluation {
    /// True if the correction is better by more than one standard error.
    pub fn is_better(&self) -> bool {
        self.standard_error.is_some_and(|error| self.foundation - self.branch > error)
    }

    /// True if the correction is worse by more than one standard error.
    pub fn is_worse(&self) -> bool {
        self.standard_error.is_some_and(|error| self.branch - self.foundation > error)
    }
}

/// Evaluates a training on held-out trials, a part of them at a time. The foundation may have been
/// fitted to all of them, which is in its favour. Returns `None` if there is only one trial, as
/// nothing is left to train on.
///
/// # Errors
/// Returns the errors of the training and of the simulations.
pub fn evaluate_training(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &CorrectionTraining,
) -> Result<Option<CorrectionEvaluation>, TrainError> {
    let folds = HeldOutFold::with_one_foundation(model, trials.len());
    let held_out = HeldOutTrials { law, trials, folds: &folds };
    evaluate_folds(&held_out, training, ReplaySettings::default().step_s)
}

/// Evaluates a training on held-out trials, by simulations with a largest step of `step_s`, s.
/// Returns `None` if no trial is held out.
///
/// # Errors
/// Returns the errors of the training and of the simulations.
pub fn evaluate_folds(
    on: &HeldOutTrials<'_>,
    training: &CorrectionTraining,
    step_s: f64,
) -> Result<Option<CorrectionEvaluation>, TrainError> {
    let scales = ErrorScales { deviations: standard_deviations(on.trials), step_s };
    let part = |fold: &HeldOutFold| evaluate_fold(on, fold, training, &scales);
    // Folds are trained in parallel, each with its own correction.
    let parts: Vec<Vec<(usize, TrialEvaluation)>> =
        on.folds.par_iter().map(part).collect::<Result<_, TrainError>>()?;
    let mut judged: Vec<(usize, TrialEvaluation)> = parts.into_iter().flatten().collect();
    // Folds hold out every n-th trial: restore the order of the trials.
    judged.sort_by_key(|(place, _)| *place);
    let trials: Vec<TrialEvaluation> = judged.into_iter().map(|(_, trial)| trial).collect();
    Ok((!trials.is_empty()).then(|| mean_evaluation(trials)))
}

/// Divisors of the errors, and the largest step of the simulations.
struct ErrorScales {
    deviations: BTreeMap<Channel, f64>,
    step_s: f64,
}

/// Evaluates the held-out trials of a fold, by its foundation and by the correction trained on the
/// other trials.
fn evaluate_fold(
    on: &HeldOutTrials<'_>,
    fold: &HeldOutFold,
    training: &CorrectionTraining,
    scales: &ErrorScales,
) -> Result<Vec<(usize, TrialEvaluation)>, TrainError> {
    let both = on.corrected_model(fold, training)?;
    let of = |&place: &usize| -> Result<(usize, TrialEvaluation), TrainError> {
        let trial = on.trials[place];
        // The same simulations with and without the correction, so that only it differs.
        let (foundation, _) = simulate_trial(&fold.foundation, on.law, trial, scales)?;
        let (branch, share) = simulate_trial(&both, on.law, trial, scales)?;
        let share = share.unwrap_or(0.0);
        Ok((place, TrialEvaluation { name: trial.name.clone(), foundation, branch, share }))
    };
    fold.held_out.iter().map(of).collect()
}

/// Simulates a trial, restarted every ten ship lengths and as a whole. Returns its errors, and the
/// mean share of the correction.
fn simulate_trial(
    model: &Model,
    law: &Law,
    trial: &Trial,
    scales: &ErrorScales,
) -> Result<(TrialError, Option<f64>), TrainError> {
    let mut ship = Ship::new(model, law)?;
    let speeds = trial.channel(Channel::U).into_iter().flatten();
    // Widens the envelope to the fastest recorded speed, which may exceed the approach speed.
    ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
    let run = |restart_s: Option<f64>| {
        let settings =
            ReplaySettings { restart_s, step_s: scales.step_s, ..ReplaySettings::default() };
        replay_trial(&ship, trial, &settings).map_err(crate::rows::RowsError::from)
    };
    let restarted = run(Some(RESTART_LENGTHS * ship.lpp_m() / ship.approach_speed_m_s()))?;
    // The share is taken along the restarted simulation, which stays close to the trial.
    let (share, whole) = (ship.mean_correction_share(&restarted.track), run(None)?);
    let (rmse, stopped) =
        (SquaredError::from_trial(trial, &restarted).rmse_by_channel(), restarted.stopped.clone());
    let horizon = |run| HorizonErrors::with_stops(&[trial], &[run], &scales.deviations);
    let (standardised_mse, _) = combine_horizons(&[horizon(restarted), horizon(whole)]);
    let stopped = stopped.as_ref().map(ToString::to_string);
    Ok((TrialError { rmse, standardised_mse, stopped }, share))
}

/// Means over the trials, and the standard error of the mean gain.
fn mean_evaluation(trials: Vec<TrialEvaluation>) -> CorrectionEvaluation {
    let count = trials.len() as f64;
    let mean = |of: &dyn Fn(&TrialEvaluation) -> f64| trials.iter().map(of).sum::<f64>() / count;
    let gain =
        |trial: &TrialEvaluation| trial.foundation.standardised_mse - trial.branch.standardised_mse;
    let mean_gain = mean(&gain);
    let squares: f64 = trials.iter().map(|trial| (gain(trial) - mean_gain).powi(2)).sum();
    // Of a mean over trials: sqrt(sum of squared deviations / (n (n - 1))).
    let standard_error = (trials.len() > 1).then(|| (squares / (count * (count - 1.0))).sqrt());
    CorrectionEvaluation {
        foundation: mean(&|trial| trial.foundation.standardised_mse),
        branch: mean(&|trial| trial.branch.standardised_mse),
        standard_error,
        share: mean(&|trial| trial.share),
        trials,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn judged(foundation: f64, branch: f64) -> TrialEvaluation {
        let error = |standardised_mse| TrialError {
            rmse: BTreeMap::new(),
            standardised_mse,
            stopped: None,
        };
        TrialEvaluation {
            name: "t".into(),
            foundation: error(foundation),
            branch: error(branch),
            share: 0.5,
        }
    }

    #[test]
    fn a_branch_wins_by_more_than_the_scatter_of_its_gains() {
        let even = mean_evaluation(vec![judged(2.0, 1.0), judged(4.0, 2.8), judged(3.0, 2.1)]);
        assert!((even.foundation - 3.0).abs() < 1e-12 && (even.branch - 5.9 / 3.0).abs() < 1e-12);
        // Gains of 1, 1.2 and 0.9 scatter by 0.153; by the root of 3 that is 0.088.
        assert!((even.standard_error.unwrap() - 0.0882).abs() < 1e-4 && even.is_better());
        let uneven = mean_evaluation(vec![judged(2.0, 1.0), judged(2.0, 3.0), judged(3.0, 2.9)]);
        assert!(!uneven.is_better());
    }

    #[test]
    fn a_single_trial_has_no_standard_error_and_decides_nothing() {
        let one = mean_evaluation(vec![judged(2.0, 1.0)]);
        assert_eq!((one.foundation, one.branch, one.standard_error), (2.0, 1.0, None));
        assert!(!one.is_better() && !one.is_worse());
        // A number that is none would be written as null and could not be read again.
        let text = serde_json::to_string(&one).unwrap();
        assert_eq!(serde_json::from_str::<CorrectionEvaluation>(&text).unwrap(), one);
    }
}
