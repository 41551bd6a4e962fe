//! What a branch is worth: simulations of trials left out of its training, by the foundation and by
//! both together.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay};

use crate::joined::JoinError;
use crate::train::{TrainError, Training, train};
use crate::{joined, version};

/// Most parts in which trials are left out, each once.
const FOLDS: usize = 4;
/// Ship lengths sailed between restarts of a simulation, as refinements are judged.
const RESTART_LENGTHS: f64 = 10.0;

/// What a branch is worth on trials left out of its training. The foundation may have been fitted
/// on all of them, so that it is the foundation which this favours.
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
    /// Standardised mean squared error (Wakita 2022, Eq. 26).
    pub standardised_mse: f64,
    /// Why the simulation stopped early, if it did; the errors are until then.
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

/// Judges a training on trials left out, a part of them at a time; none where there is one trial
/// only, and nothing is left to train on.
///
/// # Errors
/// As [`train`].
pub fn judge(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &Training,
) -> Result<Option<Judgement>, TrainError> {
    judge_in_steps(model, law, trials, training, ReplaySettings::default().step_s)
}

/// The same by simulations whose steps are at most so long, s.
pub(crate) fn judge_in_steps(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &Training,
    step_s: f64,
) -> Result<Option<Judgement>, TrainError> {
    let folds = FOLDS.min(trials.len());
    if folds < 2 {
        return Ok(None);
    }
    let scales = Scales { deviations: standard_deviations(trials), step_s };
    let part = |fold: usize| left_out(model, law, trials, training, (fold, folds), &scales);
    let parts: Vec<Vec<(usize, JudgedTrial)>> =
        (0..folds).into_par_iter().map(part).collect::<Result<_, TrainError>>()?;
    let mut judged: Vec<(usize, JudgedTrial)> = parts.into_iter().flatten().collect();
    judged.sort_by_key(|(place, _)| *place);
    Ok(Some(summed(judged.into_iter().map(|(_, trial)| trial).collect())))
}

/// By what errors are divided, and in what steps simulations go.
struct Scales {
    deviations: BTreeMap<Channel, f64>,
    step_s: f64,
}

/// The trials of a part, by a branch trained on the others.
fn left_out(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &Training,
    (fold, folds): (usize, usize),
    scales: &Scales,
) -> Result<Vec<(usize, JudgedTrial)>, TrainError> {
    let (outside, inside): (Vec<_>, Vec<_>) =
        trials.iter().copied().enumerate().partition(|(place, _)| place % folds == fold);
    let inside: Vec<&Trial> = inside.into_iter().map(|(_, trial)| trial).collect();
    let foundation = model.foundation();
    let (branch, weights) = train(&foundation, law, &inside, training)?;
    let mut both = version::with_branch(&foundation, branch);
    joined::attach(&mut both, &weights.bytes()?).map_err(Box::<JoinError>::from)?;
    let of = |(place, trial): (usize, &Trial)| -> Result<(usize, JudgedTrial), TrainError> {
        let (foundation, _) = simulated(&foundation, law, trial, scales)?;
        let (branch, share) = simulated(&both, law, trial, scales)?;
        let share = share.unwrap_or(0.0);
        Ok((place, JudgedTrial { name: trial.name.clone(), foundation, branch, share }))
    };
    outside.into_iter().map(of).collect()
}

/// A trial simulated, started anew every ten ship lengths: how far off it is, and what the branch
/// counted for.
fn simulated(
    model: &Model,
    law: &Law,
    trial: &Trial,
    scales: &Scales,
) -> Result<(TrialError, Option<f64>), TrainError> {
    let mut ship = Ship::new(model, law)?;
    let speeds = trial.channel(Channel::U).into_iter().flatten();
    ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
    let restart_s = Some(RESTART_LENGTHS * ship.lpp_m() / ship.approach_speed_m_s());
    let settings = ReplaySettings { restart_s, step_s: scales.step_s, ..ReplaySettings::default() };
    let run = replay(&ship, trial, &settings).map_err(crate::rows::RowsError::from)?;
    let error = SquaredError::of(trial, &run);
    let error = TrialError {
        rmse: error.rmse(),
        standardised_mse: standardised_mse(&error, &scales.deviations),
        stopped: run.stopped.as_ref().map(ToString::to_string),
    };
    Ok((error, ship.branch_share(&run.track)))
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
