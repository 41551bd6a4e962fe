//! Plotted trials, simulated by the model before and after.

use sistership_diagnosis::ResidualSeries;
use sistership_model::Model;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, TrialReplay, replay_trial};
use sistership_simulation::{PlantError, Ship};

use super::input::DiagnosisInput;
use crate::plots::HullOutline;
use crate::replayed::{ReplaySummary, ReplayedTrial};

/// Largest number of plotted trials.
const MOST: usize = 4;

/// Simulates the trials with the largest residuals; those that lack a channel are omitted. Here the
/// source is the model before, and the refined model is the one after.
pub(crate) fn replay_chosen<'a>(
    input: &DiagnosisInput<'a>,
) -> Result<Vec<ReplayedTrial<'a>>, PlantError> {
    // Without a new model both simulations are equal.
    let after = input.diagnosis.model.as_ref().unwrap_or(input.model);
    let (before, after) = (prepare_ship(input.model, input)?, prepare_ship(after, input)?);
    let settings = ReplaySettings::default();
    let one = |trial: &'a Trial| {
        let (before, after) =
            // A failed simulation only removes the plot, not the report.
            (replay_trial(&before, trial, &settings).ok()?, replay_trial(&after, trial, &settings).ok()?);
        Some(replayed_trial(input, trial, before, after))
    };
    Ok(ranked_trials(input).into_iter().filter_map(one).take(MOST).collect())
}

fn replayed_trial<'a>(
    input: &DiagnosisInput<'a>,
    trial: &'a Trial,
    before: TrialReplay,
    after: TrialReplay,
) -> ReplayedTrial<'a> {
    let stopped = |run: &TrialReplay| run.stopped.as_ref().map(ToString::to_string);
    let shown = ReplaySummary {
        trial: &trial.name,
        manoeuvre: trial.manoeuvre.as_deref(),
        duration_s: trial.duration_s(),
        fitted: true,
        source: SquaredError::from_trial(trial, &before).rmse_by_channel(),
        refined: SquaredError::from_trial(trial, &after).rmse_by_channel(),
        source_stopped: stopped(&before),
        refined_stopped: stopped(&after),
    };
    let hull = HullOutline::from_particulars(&input.model.particulars);
    ReplayedTrial {
        trial,
        source: before,
        refined: after,
        rolls: input.law.has_roll(),
        hull,
        shown,
    }
}

/// Ship whose envelope covers the speeds of the trials.
fn prepare_ship(model: &Model, input: &DiagnosisInput<'_>) -> Result<Ship, PlantError> {
    let mut ship = Ship::new(model, input.law)?;
    let speeds =
        input.trials.iter().flat_map(|trial| trial.channel(Channel::U).into_iter().flatten());
    ship.set_envelope_speed(speeds.fold(0.0, |most: f64, speed| most.max(speed.abs())));
    Ok(ship)
}

/// Trials in order of decreasing residual relative to the noise.
fn ranked_trials<'a>(input: &DiagnosisInput<'a>) -> Vec<&'a Trial> {
    let size = |trial: &Trial| {
        let own = input.diagnosis.residuals.iter().filter(|series| series.trial == trial.name);
        own.map(over_noise).fold(0.0, f64::max)
    };
    let mut trials: Vec<(f64, &Trial)> =
        input.trials.iter().map(|trial| (size(trial), *trial)).collect();
    trials.sort_by(|a, b| b.0.total_cmp(&a.0));
    trials.into_iter().map(|(_, trial)| trial).collect()
}

/// Root mean squared residual relative to the noise.
fn over_noise(series: &ResidualSeries) -> f64 {
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let noise = square(&series.band);
    if noise > 0.0 { (square(&series.before) / noise).sqrt() } else { 0.0 }
}
