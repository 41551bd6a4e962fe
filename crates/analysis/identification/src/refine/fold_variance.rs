//! Sensitivity of a candidate to single trials, in manoeuvres that no trial covers.
//!
//! Errors on held-out trials measure a model in manoeuvres like those of the trials. Between and
//! beyond them the trials do not determine the model: the models of folds, which each missed some
//! of the trials and fit the others as well, differ there. Their scatter is the jackknife's
//! estimate of the variance of what the candidate simulates, `(g - 1) / g sum (x_i - mean x)^2`
//! over `g` folds (Efron and Tibshirani 1993, An introduction to the bootstrap, Eq. 11.5).

use sistership_model::Model;
use sistership_model::trial::Trial;
use sistership_simulation::error::{SquaredError, standardised_mse};
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, TrialReplay, replay_trials};
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector};

use super::problem::RefinementProblem;
use super::rudder_orders::{RudderOrder, rudder_records};
use super::simulated::sister_coefficients;
use super::thresholds::HELM;
use sistership_priors::transfer::prepare_sister_ships;

/// Jackknife variance of simulated states under rudder orders that no trial had, at the speed of the
/// trials, standardised and summed over channels as errors on held-out trials are. Infinite if a
/// fold's model cannot be simulated to the end, at half the speed either; `None` if fewer than two
/// folds have models, or if the records lack an input of the law.
pub(super) fn fold_variance(problem: &RefinementProblem<'_>, folds: &[Model]) -> Option<f64> {
    let first = folds.first().filter(|_| folds.len() > 1)?;
    let asked = RudderOrder::random_orders(HELM.records);
    let helms = rudder_records(
        (&problem.transferred, problem.law),
        &problem.whole,
        (&asked, HELM.lengths),
    )?;
    let ship = prepare_sister_ships(first, problem.law, &problem.whole).ok()?;
    let coefficients = sister_coefficients(&ship, folds).ok()?;
    let each =
        |trial| coefficients.iter().map(move |one| RecordedTrial { trial, coefficients: one });
    let all: Vec<RecordedTrial<'_>> = helms.iter().flat_map(each).collect();
    // The same step as for held-out trials, so that both figures have the same integration error.
    let step_s = problem.replayed.step_s;
    let settings = ReplaySettings { step_s, ..ReplaySettings::default() };
    let runs = replay_trials(&ship, &all, &settings).ok()?;
    if runs.iter().any(|run| run.stopped.is_some()) {
        return Some(f64::INFINITY);
    }
    let mut about_mean = SquaredError::default();
    // Scatter at half the speed, where there are no trials, says nothing of errors at theirs
    // (docs/evidence/selection.md).
    for (helm, runs) in helms.iter().zip(runs.chunks(folds.len())).take(asked.len()) {
        let mean = mean_record(helm, runs);
        runs.iter().for_each(|run| about_mean.add(&SquaredError::from_trial(&mean, run)));
    }
    // The mean over the samples of all folds has the jackknife's `1/g` already.
    Some((folds.len() - 1) as f64 * standardised_mse(&about_mean, &problem.deviations))
}

/// A record of the mean of the folds' states at each sample.
fn mean_record(helm: &Trial, runs: &[TrialReplay]) -> Trial {
    let mean = |sample: usize| {
        runs.iter().map(|run| run.track.states[sample]).sum::<StateVector>() / runs.len() as f64
    };
    let states: Vec<StateVector> = (0..helm.len()).map(mean).collect();
    let column = |place: usize| states.iter().map(|state| state[place]).collect();
    let channels = RECORDED_CHANNELS.iter().map(|&(channel, place)| (channel, column(place)));
    Trial { channels: channels.collect(), ..helm.clone() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::refine::settings::RefinementSettings;
    use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};

    #[test]
    fn folds_that_differ_by_twice_as_much_have_four_times_the_variance() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        let problem =
            RefinementProblem::from_model(&model, &law, &trials, RefinementSettings::default());
        let fold = |by: f64| {
            with_scaled_coefficients(&model, |name| if name == "N_delta" { 1.0 + by } else { 1.0 })
        };
        let variance =
            |apart: f64| fold_variance(&problem, &[fold(-apart), fold(apart), fold(0.0)]);
        assert!(variance(0.0).unwrap() < 1e-20);
        let (once, twice) = (variance(0.005).unwrap(), variance(0.01).unwrap());
        assert!(once > 0.0 && (twice / once - 4.0).abs() < 0.2, "{once} {twice}");
        assert_eq!(fold_variance(&problem, &[fold(0.0)]), None);
    }

    #[test]
    fn a_fold_that_does_not_sail_is_infinitely_far() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        let problem =
            RefinementProblem::from_model(&model, &law, &trials, RefinementSettings::default());
        let runs_away =
            with_scaled_coefficients(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        let folds = [model.clone(), runs_away];
        assert_eq!(fold_variance(&problem, &folds), Some(f64::INFINITY));
    }
}
