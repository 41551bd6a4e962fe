//! What a branch is worth: simulations of trials left out of its training, by the foundation and by
//! both together.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations};
use sistership_simulation::horizons::{HorizonErrors, combined};
use sistership_simulation::recorded::{ReplaySettings, replay};

use crate::held_out::{HeldOutFold, HeldOutTrials};
use crate::train::{TrainError, Training};

/// Ship lengths sailed between restarts of a simulation; each trial is simulated as a whole, too,
/// and the error is the geometric mean of both.
const RESTART_LENGTHS: f64 = 10.0;

/// What a branch is worth on trials left out of its training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// Each trial, by a branch that was trained without it.
    pub trials: Vec<JudgedTrial>,
    /// Standardised mean squared error of the foundation, mean over the trials.
    pub foundation: f64,
    /// The same with the branch.
    pub branch: f64,
    /// Standard error of the difference of the two over the trials.
    pub standard_error: f64,
    /// What the branch counted for in the mean over these simulations, 0 to 1.
    pub share: f64,
}

/// A trial that a branch has not seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JudgedTrial {
    /// Its name.
    pub name: String,
    /// By the foundation.
    pub foundation: TrialError,
    /// With the branch.
    pub branch: TrialError,
    /// What the branch counted for in the mean over the simulation, 0 to 1.
    pub share: f64,
}

/// How far a simulation is from a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialError {
    /// Root mean squares by channel, SI.
    pub rmse: BTreeMap<String, f64>,
    /// Standardised mean squared error (Wakita 2022, Eq. 26), the geometric mean of simulations
    /// that restart every ten ship lengths and of the whole trial; what is not simulated since one
    /// stopped counts as an unrelated motion would.
    pub standardised_mse: f64,
    /// Why the simulation stopped early, if it did; the root mean squares are until then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

impl Judgement {
    /// Whether the branch is better by more than one standard error.
    pub fn wins(&self) -> bool {
        self.foundation - self.branch > self.standard_error
    }

    /// Whether it is worse by more than one standard error.
    pub fn loses(&self) -> bool {
        self.branch - self.foundation > self.standard_error
    }
}

/// Judges a training on trials left out, a part of them at a time, beside a foundation that may
/// have been fitted on all of them, which this favours; none where there is one trial only, and
/// nothing is left to train on.
///
/// # Errors
/// As [`train`](crate::train()).
pub fn judge(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &Training,
) -> Result<Option<Judgement>, TrainError> {
    let folds = HeldOutFold::of_one(model, trials.len());
    let held_out = HeldOutTrials { law, trials, folds: &folds };
    judge_folds(&held_out, training, ReplaySettings::default().step_s)
}

/// Judges a training on trials held out by simulations whose steps are at most so long, s; none
/// where nothing is held out.
///
/// # Errors
/// As [`judge`].
pub fn judge_folds(
    on: &HeldOutTrials<'_>,
    training: &Training,
    step_s: f64,
) -> Result<Option<Judgement>, TrainError> {
    let scales = Scales { deviations: standard_deviations(on.trials), step_s };
    let part = |fold: &HeldOutFold| judged(on, fold, training, &scales);
    let parts: Vec<Vec<(usize, JudgedTrial)>> =
        on.folds.par_iter().map(part).collect::<Result<_, TrainError>>()?;
    let mut judged: Vec<(usize, JudgedTrial)> = parts.into_iter().flatten().collect();
    judged.sort_by_key(|(place, _)| *place);
    let trials: Vec<JudgedTrial> = judged.into_iter().map(|(_, trial)| trial).collect();
    Ok((!trials.is_empty()).then(|| summed(trials)))
}

/// By what errors are divided, and in what steps simulations go.
struct Scales {
    deviations: BTreeMap<Channel, f64>,
    step_s: f64,
}

/// The trials of a fold, by its foundation and by the branch trained on the others.
fn judged(
    on: &HeldOutTrials<'_>,
    fold: &HeldOutFold,
    training: &Training,
    scales: &Scales,
) -> Result<Vec<(usize, JudgedTrial)>, TrainError> {
    let both = on.corrected(fold, training)?;
    let of = |&place: &usize| -> Result<(usize, JudgedTrial), TrainError> {
        let trial = on.trials[place];
        let (foundation, _) = simulated(&fold.foundation, on.law, trial, scales)?;
        let (branch, share) = simulated(&both, on.law, trial, scales)?;
        let share = share.unwrap_or(0.0);
        Ok((place, JudgedTrial { name: trial.name.clone(), foundation, branch, share }))
    };
    fold.held_out.iter().map(of).collect()
}

/// A trial simulated, started anew every ten ship lengths and as a whole: how far off it is, and
/// what the branch counted for.
fn simulated(
    model: &Model,
    law: &Law,
    trial: &Trial,
    scales: &Scales,
) -> Result<(TrialError, Option<f64>), TrainError> {
    let mut ship = Ship::new(model, law)?;
    let speeds = trial.channel(Channel::U).into_iter().flatten();
    ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
    let run = |restart_s: Option<f64>| {
        let settings =
            ReplaySettings { restart_s, step_s: scales.step_s, ..ReplaySettings::default() };
        replay(&ship, trial, &settings).map_err(crate::rows::RowsError::from)
    };
    let restarted = run(Some(RESTART_LENGTHS * ship.lpp_m() / ship.approach_speed_m_s()))?;
    let (share, whole) = (ship.branch_share(&restarted.track), run(None)?);
    let (rmse, stopped) = (SquaredError::of(trial, &restarted).rmse(), restarted.stopped.clone());
    let horizon = |run| HorizonErrors::with_stops(&[trial], &[run], &scales.deviations);
    let (standardised_mse, _) = combined(&[horizon(restarted), horizon(whole)]);
    let stopped = stopped.as_ref().map(ToString::to_string);
    Ok((TrialError { rmse, standardised_mse, stopped }, share))
}

fn summed(trials: Vec<JudgedTrial>) -> Judgement {
    let count = trials.len() as f64;
    let mean = |of: &dyn Fn(&JudgedTrial) -> f64| trials.iter().map(of).sum::<f64>() / count;
    let gain =
        |trial: &JudgedTrial| trial.foundation.standardised_mse - trial.branch.standardised_mse;
    let mean_gain = mean(&gain);
    let squares: f64 = trials.iter().map(|trial| (gain(trial) - mean_gain).powi(2)).sum();
    Judgement {
        foundation: mean(&|trial| trial.foundation.standardised_mse),
        branch: mean(&|trial| trial.branch.standardised_mse),
        standard_error: (squares / (count * (count - 1.0))).sqrt(),
        share: mean(&|trial| trial.share),
        trials,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(foundation: f64, branch: f64) -> JudgedTrial {
        let error = |standardised_mse| TrialError {
            rmse: BTreeMap::new(),
            standardised_mse,
            stopped: None,
        };
        JudgedTrial {
            name: "t".into(),
            foundation: error(foundation),
            branch: error(branch),
            share: 0.5,
        }
    }

    #[test]
    fn a_branch_wins_by_more_than_the_scatter_of_its_gains() {
        let even = summed(vec![judged(2.0, 1.0), judged(4.0, 2.8), judged(3.0, 2.1)]);
        assert!((even.foundation - 3.0).abs() < 1e-12 && (even.branch - 5.9 / 3.0).abs() < 1e-12);
        // Gains of 1, 1.2 and 0.9 scatter by 0.153; by the root of 3 that is 0.088.
        assert!((even.standard_error - 0.0882).abs() < 1e-4 && even.wins());
        let uneven = summed(vec![judged(2.0, 1.0), judged(2.0, 3.0), judged(3.0, 2.9)]);
        assert!(!uneven.wins());
    }
}
