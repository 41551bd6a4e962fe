//! Widening of a posterior by the errors of simulated trials that a model was not fitted to.
//!
//! A law that cannot represent a ship has an error that every fold shares, so that neither the
//! noise of the readings nor the scatter of the folds shows it: the more trials, the narrower the
//! posterior about a model that stays wrong. Errors on held-out trials show it. A posterior that is
//! right has draws that differ from the estimate in these trials as much as the models of folds
//! differ from the measurement; where the latter differ more, the ratio widens it (the scale factor
//! of Birge 1932, Physical Review 40, 207-227, for errors of simulations).
//! docs/evidence/foreign_ships.md has the coverage with and without it.

use sistership_assessment::uncertainty::{Sampling, draw_from_posterior};
use sistership_model::Model;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::recorded::TrialReplay;
use sistership_simulation::state::RECORDED_CHANNELS;

use super::problem::RefinementProblem;
use super::simulated::simulate_runs;

/// Draws that estimate how far models of the posterior differ.
const DRAWS: usize = 20;
/// Fewest folds: two models have seen half of the trials each.
const FOLDS: usize = 3;
/// Time between the errors that are multiplied, by the window in which readings are smoothed: noise
/// of single readings has no product over it, a wrong model has.
const LAG_WINDOWS: f64 = 2.0;
/// Channels that are compared, velocities and heading: positions repeat these.
const CHANNELS: [(Channel, usize); 4] =
    [RECORDED_CHANNELS[0], RECORDED_CHANNELS[1], RECORDED_CHANNELS[2], RECORDED_CHANNELS[3]];

/// Sum over trials of the mean squares in each channel; none where a trial lacks the channel.
type ChannelSquares = [Option<f64>; CHANNELS.len()];

/// Returns the root of the ratio of the mean squared error of held-out trials, without noise, to the
/// posterior's variance there, in the mean over the channels; at least 1, and 1 if a simulation does
/// not run to its end or there are fewer than three folds.
pub(super) fn misfit_factor(
    problem: &RefinementProblem<'_>,
    model: &Model,
    left_out: &[Model],
) -> f64 {
    if left_out.len() < FOLDS {
        return 1.0;
    }
    let squares = error_squares(problem, left_out).zip(posterior_squares(problem, model));
    let Some((observed, predicted)) = squares else { return 1.0 };
    // The model of a fold lacks one trial in `g`.
    let share = 1.0 - 1.0 / left_out.len() as f64;
    let pairs = observed.into_iter().zip(predicted);
    let ratios: Vec<f64> = pairs
        .filter_map(|(observed, predicted)| observed.zip(predicted.filter(|square| *square > 0.0)))
        .map(|(observed, predicted)| share * observed / predicted)
        .collect();
    // The mean over channels: the sum would be that of the heading, whose errors grow with time.
    let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
    mean.max(1.0).sqrt()
}

/// Squared errors, without noise, of the models of folds on the trials that each has not seen.
fn error_squares(problem: &RefinementProblem<'_>, left_out: &[Model]) -> Option<ChannelSquares> {
    let trials: Vec<&Trial> = problem.replayed.trials.iter().collect();
    let runs = simulate_runs(problem, &trials, left_out, &|trial| problem.fold_of(trial))?;
    let window_s = problem.settings.smoothing_s.unwrap_or_default();
    Some(CHANNELS.map(|(channel, place)| {
        let each = trials.iter().zip(&runs).map(|(trial, run)| {
            let column = trial.channel(channel)?;
            let error = |k: usize| run.track.states[k][place] - column[run.samples[k]];
            // Samples closer than the window share their readings.
            let lag = (LAG_WINDOWS * window_s / trial.interval_s()).ceil().max(1.0) as usize;
            mean_product(&error, run.samples.len().checked_sub(lag)?, lag)
        });
        each.sum()
    }))
}

/// Mean product of the errors a lag apart.
fn mean_product(error: &dyn Fn(usize) -> f64, count: usize, lag: usize) -> Option<f64> {
    let products = (0..count).map(|k| error(k) * error(k + lag));
    (count > 0).then(|| products.sum::<f64>() / count as f64)
}

/// Mean squares between draws of the posterior and the estimate in the trials.
fn posterior_squares(problem: &RefinementProblem<'_>, model: &Model) -> Option<ChannelSquares> {
    let trials: Vec<&Trial> = problem.replayed.trials.iter().collect();
    let draws = draw_from_posterior(model, Sampling { samples: DRAWS, ..Sampling::default() })?;
    let own = simulate_runs(problem, &trials, std::slice::from_ref(model), &|_| 0)?;
    // Every draw in every trial in lockstep: one simulation costs hardly more than its share.
    let repeated = trials.repeat(draws.len());
    let drawn = simulate_runs(problem, &repeated, &draws, &|run| run / trials.len())?;
    Some(CHANNELS.map(|(_, place)| {
        let each = drawn.iter().zip(own.iter().cycle());
        let squares = each.map(|(drawn, own)| mean_square_between(drawn, own, place));
        Some(squares.sum::<f64>() / draws.len() as f64)
    }))
}

/// Mean square between two simulations of a trial in one state.
fn mean_square_between(one: &TrialReplay, other: &TrialReplay, place: usize) -> f64 {
    let pairs = one.track.states.iter().zip(&other.track.states);
    let squares = pairs.map(|(a, b)| (a[place] - b[place]).powi(2)).sum::<f64>();
    squares / one.track.states.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::refine::settings::RefinementSettings;
    use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};
    use sistership_model::posterior::Posterior;

    /// Factor for folds that are all off by a share in the rudder's moment, where the posterior has
    /// a deviation of half a per cent.
    fn factor(off: f64, folds: usize, noise: f64) -> f64 {
        let (mut model, law) = mariner_model();
        let mut trials = simulated_trials(&model, &law, 0.0);
        trials.iter_mut().for_each(|trial| add_noise(trial, noise));
        let own = model.coefficient("N_delta");
        model.posterior = Some(Posterior {
            names: vec!["N_delta".to_owned()],
            values: vec![own],
            deviations: vec![0.005 * own.abs()],
            root_correlation: Posterior::format_rows(1, &|_, _| 1.0),
        });
        let trials: Vec<&Trial> = trials.iter().collect();
        let settings = RefinementSettings::default();
        let problem = RefinementProblem::from_model(&model, &law, &trials, settings);
        let scale = |name: &str| if name == "N_delta" { 1.0 + off } else { 1.0 };
        let fold = with_scaled_coefficients(&model, scale);
        let left_out = vec![fold; problem.fold_count().min(folds)];
        misfit_factor(&problem, &model, &left_out)
    }

    /// Adds noise without correlation, by a share of each channel's size, to all but the first sample.
    fn add_noise(trial: &mut Trial, share: f64) {
        let white =
            |k: usize| 2.0 * (43_758.545_3 * (12.9898 * k as f64).sin()).rem_euclid(1.0) - 1.0;
        for (place, (channel, _)) in CHANNELS.into_iter().enumerate() {
            let column = trial.channels.get_mut(&channel).unwrap();
            let size = column.iter().map(|value| value.abs()).fold(0.0, f64::max);
            for (k, value) in column.iter_mut().enumerate().skip(1) {
                *value += share * size * white(k + 10_007 * place);
            }
        }
    }

    #[test]
    fn an_error_that_every_fold_shares_widens_in_proportion() {
        let (once, twice) = (factor(0.02, 9, 0.0), factor(0.04, 9, 0.0));
        assert!((2.0..5.0).contains(&once), "about four deviations off: {once}");
        assert!((twice / once - 2.0).abs() < 0.1, "{once} {twice}");
    }

    #[test]
    fn what_the_posterior_expects_and_too_few_folds_widen_nothing() {
        assert_eq!(factor(0.002, 9, 0.0), 1.0);
        assert_eq!(factor(0.04, 2, 0.0), 1.0);
    }

    #[test]
    fn noise_of_single_readings_is_no_misfit() {
        let (clean, noisy) = (factor(0.02, 9, 0.0), factor(0.02, 9, 0.01));
        // Squares without a lag would be hundreds of times those of the error in surge.
        assert!((noisy / clean - 1.0).abs() < 0.3, "{clean} {noisy}");
    }
}
