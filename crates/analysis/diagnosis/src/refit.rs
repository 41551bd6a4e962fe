//! Final fit of the coefficients with the effects in place: they no longer compensate for missing
//! effects.

use sistership_model::effect::{AppliedEffect, AsTerms};
use sistership_model::law::Law;
use sistership_model::{Model, Trial, particulars};
use sistership_simulation::equations::EquationsOfMotion;

use super::Request;
use super::corrected::{CorrectedRecords, joined, split};
use super::hypothesis::JudgedHypothesis;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use super::values::model_with;
use sistership_identification::refine::{
    Alternative, Blocks, RefineError, alternatives, fit, trial_moments,
};
use sistership_numerics::{Moments, RidgeChoice};
use sistership_priors::transfer::approach_of;

/// A model with effects, fitted on all trials and without each of them.
pub(super) struct Refit {
    /// Method of the fit of its coefficients; none where they are unchanged.
    pub how: Option<String>,
    pub all: Model,
    pub without: Vec<Model>,
}

/// Alternatives of the final fit: the coefficients unchanged; fitted with the effects as they were
/// found; and, where the effects on the ship are linear, fitted together with them. Regressions use
/// trials corrected for the errors of their instruments. With a learned correction the coefficients
/// stay unchanged: it was trained on their remainder, and would not suit others.
pub(super) fn refits(
    request: &Request<'_>,
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    restart_s: f64,
) -> Result<Vec<Refit>, RefineError> {
    let all = model_with(search.model, &judged.candidates, Some(&judged.covariance));
    let without = (0..request.trials.len())
        .map(|trial| without(request, search, judged, trial))
        .collect::<Result<_, _>>()?;
    let found = Refit { how: None, all, without };
    let may_move = !judged.candidates.is_empty() && request.model.branch.is_none();
    let corrected = may_move.then(|| CorrectedRecords::new(request, &found.all)).flatten();
    let mut fitted = Vec::new();
    if let Some(corrected) = corrected {
        let request = &Request { trials: &corrected.trials(), ..*request };
        fitted.extend(
            THRESHOLDS.refit.strengths.iter().filter_map(|&lambda| ridge(request, &found, lambda)),
        );
        fitted.extend(jointly(request, &found, restart_s));
    }
    Ok(std::iter::once(found).chain(fitted).collect())
}

/// All trials but one; a single trial is itself.
fn others<'a>(request: &Request<'a>, but: usize) -> Vec<&'a Trial> {
    let count = request.trials.len();
    (0..count)
        .filter(|&other| other != but || count == 1)
        .map(|other| request.trials[other])
        .collect()
}

/// The model with effects estimated on the other trials.
fn without(
    request: &Request<'_>,
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    trial: usize,
) -> Result<Model, RefineError> {
    let keep = |other: usize| other != trial || request.trials.len() == 1;
    let (_, candidates) = judged.of_trials(&search.fixed, &keep)?;
    Ok(match candidates.is_empty() {
        true => request.model.clone(),
        false => model_with(search.model, &candidates, None),
    })
}

fn ridge(request: &Request<'_>, found: &Refit, lambda: f64) -> Option<Refit> {
    let fitted = |model: &Model, trials: &[&Trial]| {
        let (ship, instruments) = split(model);
        Some(joined(with_coefficients(&ship, request.law, trials, lambda)?, instruments))
    };
    let one = |(trial, model): (usize, &Model)| fitted(model, &others(request, trial));
    Some(Refit {
        how: Some(format!("prior strength {lambda}")),
        all: fitted(&found.all, request.trials)?,
        without: found.without.iter().enumerate().map(one).collect::<Option<_>>()?,
    })
}

/// Coefficients and effects on the ship fitted together, by the weak form and by trajectories. Only
/// the selection of these effects is taken from the diagnosis. A held-out trial affects the point
/// about which trajectories are linearised, the strength of the initial weak form, and the
/// correction of records, but no residual.
fn jointly(request: &Request<'_>, found: &Refit, restart_s: f64) -> Vec<Refit> {
    let (ship, instruments) = split(&found.all);
    let Ok(Some(terms)) = AsTerms::new(&ship, request.law) else { return Vec::new() };
    let all = alternatives(&terms.model, &terms.law, request.trials, restart_s).unwrap_or_default();
    let back = |model: Model, instruments: Vec<AppliedEffect>| {
        let fitted =
            Model { uncertainty: None, posterior: None, ..terms.fitted(&model.coefficients) };
        joined(fitted, instruments)
    };
    let one = |Alternative { label, all, without }: Alternative| Refit {
        how: Some(format!("together with the effects: {label}")),
        all: back(all, instruments.clone()),
        // Errors of instruments stay those that the diagnosis estimated without the trial.
        without: without
            .into_iter()
            .zip(&found.without)
            .map(|(model, found)| back(model, split(found).1))
            .collect(),
    };
    all.into_iter().map(one).collect()
}

fn with_coefficients(model: &Model, law: &Law, trials: &[&Trial], lambda: f64) -> Option<Model> {
    let equations = EquationsOfMotion::new(model, law).ok()?;
    let blocks = Blocks::new(model, equations.law()).ok()?;
    let speed_m_s = approach_of(trials).map(|approach| approach.speed_m_s).or(model.speed_m_s)?;
    let difference_s =
        THRESHOLDS.refit.difference * particulars::value(&model.particulars, "lpp_m")? / speed_m_s;
    let of = |trial: &&Trial| trial_moments(&blocks, trial, Some(difference_s)).ok();
    let each: Vec<Vec<Moments>> = trials.iter().map(of).collect::<Option<_>>()?;
    // Moments of the trials are merged in order, so that the result is reproducible.
    let mut total = each.first()?.clone();
    for moments in &each[1..] {
        total.iter_mut().zip(moments).for_each(|(sum, more)| sum.merge(more));
    }
    let choices = blocks
        .blocks
        .iter()
        .map(|block| vec![RidgeChoice { lambda, alpha: 0.0 }; block.axes.len()])
        .collect();
    let mut model = model.clone();
    for (name, fitted) in fit(&blocks, &total, &model, &choices).coefficients {
        let quantity = model.coefficients.get_mut(&name)?;
        (quantity.value, quantity.standard_error) = (fitted.value, Some(fitted.standard_error));
    }
    // The earlier uncertainty does not apply to the new coefficients.
    (model.uncertainty, model.posterior) = (None, None);
    Some(model)
}
