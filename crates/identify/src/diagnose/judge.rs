//! Errors before and after, on trials that the fit of the effects has not seen.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_dynamics::error::SquaredError;
use sistership_dynamics::metrics::{ManoeuvreMetrics, Recognised, recorded_track};
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_model::{Model, Trial};

use super::Request;
use super::outcome::{SailedManoeuvre, TrialErrors};
use super::search::{Judged, Search};
use crate::transfer::ready;

/// Errors and manoeuvres of all trials.
pub(super) struct Errors {
    pub before: BTreeMap<String, f64>,
    pub after: BTreeMap<String, f64>,
    pub trials: Vec<TrialErrors>,
    pub manoeuvres: Vec<SailedManoeuvre>,
}

/// One trial by both models.
struct Pair {
    before: Option<SquaredError>,
    after: Option<SquaredError>,
    trial: TrialErrors,
    manoeuvre: Option<SailedManoeuvre>,
}

/// Simulates each trial by the model as it is, and by the model with the effects fitted on the others.
pub(super) fn errors(request: &Request<'_>, search: &Search<'_>, judged: &Judged, restart_s: f64) -> Errors {
    let one = |(place, trial): (usize, &&Trial)| {
        let others = |other: usize| other != place || request.trials.len() == 1;
        let fitted = judged.of_trials(&search.fixed, &others);
        let model = match fitted {
            Some((_, candidates)) if !candidates.is_empty() => search.model_with(&candidates, None),
            _ => request.model.clone(),
        };
        pair(request, &model, trial, restart_s)
    };
    let pairs: Vec<Pair> = request.trials.par_iter().enumerate().map(one).collect();
    let total = |of: fn(&Pair) -> &Option<SquaredError>| {
        let mut sum = SquaredError::default();
        pairs.iter().filter_map(|pair| of(pair).as_ref()).for_each(|error| sum.add(error));
        sum.rmse()
    };
    Errors {
        before: total(|pair| &pair.before),
        after: total(|pair| &pair.after),
        manoeuvres: pairs.iter().filter_map(|pair| pair.manoeuvre.clone()).collect(),
        trials: pairs.into_iter().map(|pair| pair.trial).collect(),
    }
}

fn pair(request: &Request<'_>, after: &Model, trial: &Trial, restart_s: f64) -> Pair {
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let error = |model: &Model| {
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &settings).ok().filter(|run| run.stopped.is_none())?;
        Some(SquaredError::of(trial, &run))
    };
    let (of_before, of_after) = (error(request.model), error(after));
    let rmse = |error: &Option<SquaredError>| error.as_ref().map(SquaredError::rmse).unwrap_or_default();
    let errors = TrialErrors { trial: trial.name.clone(), before: rmse(&of_before), after: rmse(&of_after) };
    Pair { before: of_before, after: of_after, trial: errors, manoeuvre: manoeuvre(request, after, trial) }
}

fn manoeuvre(request: &Request<'_>, after: &Model, trial: &Trial) -> Option<SailedManoeuvre> {
    let recognised = Recognised::of(trial)?;
    let simulated = |model: &Model| -> Option<ManoeuvreMetrics> {
        let ship = ready(model, request.law, &[trial]).ok()?;
        let run = replay(&ship, trial, &ReplaySettings::default()).ok().filter(|run| run.stopped.is_none())?;
        recognised.metrics(&run.track, &run.samples)
    };
    let samples: Vec<usize> = (0..trial.len()).collect();
    let measured = recognised.metrics(&recorded_track(trial)?, &samples)?;
    Some(SailedManoeuvre { trial: trial.name.clone(), measured, before: simulated(request.model), after: simulated(after) })
}
