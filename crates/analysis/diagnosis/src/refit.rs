//! Final fit of the coefficients with the effects in place: they no longer compensate for missing
//! effects.

use sistership_model::effect::{AppliedEffect, EffectsAsTerms};
use sistership_model::law::Law;
use sistership_model::{Model, Trial, particulars};
use sistership_simulation::equations::EquationsOfMotion;

use super::DiagnosisInputs;
use super::corrected::{CorrectedRecords, join_effects, split_effects};
use super::hypothesis::JudgedHypothesis;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use super::values::model_with_effects;
use sistership_identification::refine::{
    AlternativeFit, RefineError, RegressionBlocks, alternative_fits, fit_regressions, trial_moments,
};
use sistership_numerics::{RegressionMoments, RidgeChoice};
use sistership_priors::transfer::trial_approach;

/// A model with effects, fitted on all trials and without each of them.
pub(super) struct RefittedModel {
    /// Method of the fit of its coefficients; none where they are unchanged.
    pub how: Option<String>,
    pub all: Model,
    pub without: Vec<Model>,
}

/// Alternatives of the final fit: the coefficients unchanged; fitted with the effects as they were
/// found; and, where the effects on the ship are linear, fitted together with them. Regressions use
/// trials corrected for the errors of their instruments. With a learned correction the coefficients
/// stay unchanged: it was trained on their remainder, and would not suit others.
pub(super) fn refit_alternatives(
    request: &DiagnosisInputs<'_>,
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    restart_s: f64,
) -> Result<Vec<RefittedModel>, RefineError> {
    let all = model_with_effects(search.model, &judged.candidates, Some(&judged.covariance));
    let without = (0..request.trials.len())
        .map(|trial| model_without_trial(request, search, judged, trial))
        .collect::<Result<_, _>>()?;
    let found = RefittedModel { how: None, all, without };
    let may_move = !judged.candidates.is_empty() && request.model.branch.is_none();
    let corrected = may_move.then(|| CorrectedRecords::new(request, &found.all)).flatten();
    let mut fitted = Vec::new();
    if let Some(corrected) = corrected {
        let request = &DiagnosisInputs { trials: &corrected.trials(), ..*request };
        fitted.extend(
            THRESHOLDS
                .refit
                .strengths
                .iter()
                .filter_map(|&lambda| fit_ridge(request, &found, lambda)),
        );
        fitted.extend(fit_jointly(request, &found, restart_s));
    }
    Ok(std::iter::once(found).chain(fitted).collect())
}

/// All trials but one; a single trial is itself.
fn trials_except<'a>(request: &DiagnosisInputs<'a>, but: usize) -> Vec<&'a Trial> {
    let count = request.trials.len();
    (0..count)
        .filter(|&other| other != but || count == 1)
        .map(|other| request.trials[other])
        .collect()
}

/// The model with effects estimated on the other trials.
fn model_without_trial(
    request: &DiagnosisInputs<'_>,
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    trial: usize,
) -> Result<Model, RefineError> {
    let keep = |other: usize| other != trial || request.trials.len() == 1;
    let (_, candidates) = judged.evaluate_trials(&search.fixed, &keep)?;
    Ok(match candidates.is_empty() {
        true => request.model.clone(),
        false => model_with_effects(search.model, &candidates, None),
    })
}

fn fit_ridge(
    request: &DiagnosisInputs<'_>,
    found: &RefittedModel,
    lambda: f64,
) -> Option<RefittedModel> {
    let fitted = |model: &Model, trials: &[&Trial]| {
        let (ship, instruments) = split_effects(model);
        Some(join_effects(refit_coefficients(&ship, request.law, trials, lambda)?, instruments))
    };
    let one = |(trial, model): (usize, &Model)| fitted(model, &trials_except(request, trial));
    Some(RefittedModel {
        how: Some(format!("prior strength {lambda}")),
        all: fitted(&found.all, request.trials)?,
        without: found.without.iter().enumerate().map(one).collect::<Option<_>>()?,
    })
}

/// Coefficients and effects on the ship fitted together, by the weak form and by trajectories. Only
/// the selection of these effects is taken from the diagnosis. A held-out trial affects the point
/// about which trajectories are linearised, the strength of the initial weak form, and the
/// correction of records, but no residual.
fn fit_jointly(
    request: &DiagnosisInputs<'_>,
    found: &RefittedModel,
    restart_s: f64,
) -> Vec<RefittedModel> {
    let (ship, instruments) = split_effects(&found.all);
    let Ok(Some(terms)) = EffectsAsTerms::new(&ship, request.law) else { return Vec::new() };
    let all =
        alternative_fits(&terms.model, &terms.law, request.trials, restart_s).unwrap_or_default();
    let back = |model: Model, instruments: Vec<AppliedEffect>| {
        let fitted = Model {
            uncertainty: None,
            posterior: None,
            ..terms.with_fitted_values(&model.coefficients)
        };
        join_effects(fitted, instruments)
    };
    let one = |AlternativeFit { label, all, without }: AlternativeFit| RefittedModel {
        how: Some(format!("together with the effects: {label}")),
        all: back(all, instruments.clone()),
        // Errors of instruments stay those that the diagnosis estimated without the trial.
        without: without
            .into_iter()
            .zip(&found.without)
            .map(|(model, found)| back(model, split_effects(found).1))
            .collect(),
    };
    all.into_iter().map(one).collect()
}

fn refit_coefficients(model: &Model, law: &Law, trials: &[&Trial], lambda: f64) -> Option<Model> {
    let equations = EquationsOfMotion::new(model, law).ok()?;
    let blocks = RegressionBlocks::new(model, equations.law()).ok()?;
    let speed_m_s = trial_approach(trials).map(|approach| approach.speed_m_s).or(model.speed_m_s)?;
    let difference_s = THRESHOLDS.refit.difference
        * particulars::particular_value(&model.particulars, "lpp_m")?
        / speed_m_s;
    let of = |trial: &&Trial| trial_moments(&blocks, trial, Some(difference_s)).ok();
    let each: Vec<Vec<RegressionMoments>> = trials.iter().map(of).collect::<Option<_>>()?;
    // Moments of the trials are merged in order, so that the result is reproducible.
    let mut total = each.first()?.clone();
    for moments in &each[1..] {
        total.iter_mut().zip(moments).for_each(|(sum, more)| sum.merge_samples(more));
    }
    let choices = blocks
        .blocks
        .iter()
        .map(|block| vec![RidgeChoice { lambda, alpha: 0.0 }; block.axes.len()])
        .collect();
    let mut model = model.clone();
    for (name, fitted) in fit_regressions(&blocks, &total, &model, &choices).coefficients {
        let quantity = model.coefficients.get_mut(&name)?;
        (quantity.value, quantity.standard_error) = (fitted.value, Some(fitted.standard_error));
    }
    // The earlier uncertainty does not apply to the new coefficients.
    (model.uncertainty, model.posterior) = (None, None);
    Some(model)
}
