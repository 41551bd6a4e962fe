//! Preparation of a search from a request: candidate forms, prior of the coefficients, and expected
//! discrepancy.

use std::collections::BTreeSet;
use std::sync::Arc;

use sistership_model::effect::EffectForm;
use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

use super::DiagnosisInputs;
use super::calibrated_model::CalibratedModel;
use super::discount::is_external;
use super::evidence::DiscrepancyFactor;
use super::linearised_trials::LinearisedTrials;
use super::log_priors::{log_priors, states_odds};
use super::nuisance::{
    TermForms, learned_prior, learned_terms, missing_terms, model_columns, uncalibrated_prior,
};
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{AxisDiscrepancies, EffectCandidate, FilterColumns};
use sistership_identification::refine::RefineError;

/// Candidate forms on trials: those whose channels every trial has, of effects that the model does
/// not carry, except known errors of its instruments.
pub(super) fn listed_candidates(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Vec<EffectCandidate> {
    let carried =
        |effect: &&Arc<Effect>| !model.effects.iter().any(|applied| applied.name == effect.name);
    let systematic_errors = model
        .uncertainty
        .as_ref()
        .map(|known| known.systematic_errors.as_slice())
        .unwrap_or_default();
    let of = |effect: &Arc<Effect>| -> Vec<EffectCandidate> {
        let is_systematic = |form: &EffectForm| {
            systematic_errors
                .iter()
                .any(|error| error.name == effect.name && error.form.name == form.file.name)
        };
        let forms = effect
            .forms
            .iter()
            .filter(|form| is_applicable(form, model, law, trials) && !is_systematic(form));
        let forms = forms.filter(|form| !form.file.only_as_change);
        forms.map(|form| EffectCandidate::at_absence(&effect.name, form)).collect()
    };
    effects.iter().filter(carried).flat_map(of).collect()
}

/// Forms that are candidates for a change within a trial only.
fn changing_candidates(request: &DiagnosisInputs<'_>) -> Vec<EffectCandidate> {
    let of = |effect: &Arc<Effect>| -> Vec<EffectCandidate> {
        let can = |form: &&Arc<EffectForm>| {
            form.file.only_as_change
                && is_applicable(form, request.model, request.law, request.trials)
        };
        let forms = effect.forms.iter().filter(can);
        forms.map(|form| EffectCandidate::at_absence(&effect.name, form)).collect()
    };
    request.effects.iter().flat_map(of).collect()
}

/// Names of the effects that differ from day to day.
fn daily_effects(effects: &[Arc<Effect>]) -> BTreeSet<String> {
    let daily = effects.iter().filter(|effect| effect.differs_by_day);
    daily.map(|effect| effect.name.clone()).collect()
}

/// Candidate terms of the library's grammars.
fn missing_term_candidates(request: &DiagnosisInputs<'_>) -> Vec<EffectCandidate> {
    let terms = missing_terms(request.model, request.law, request.effects, request.trials);
    terms.iter().map(|(effect, form)| EffectCandidate::at_absence(effect, form)).collect()
}

/// True for a form whose channels and particulars are there. A water jet has no propeller diameter,
/// and no effect that needs one.
fn is_applicable(form: &EffectForm, model: &Model, law: &Law, trials: &[&Trial]) -> bool {
    let everywhere =
        |channel: &_| trials.iter().all(|trial: &&Trial| trial.channel(*channel).is_some());
    let somewhere =
        |channel: &_| trials.iter().any(|trial: &&Trial| trial.channel(*channel).is_some());
    // Some forms apply only to laws without roll.
    let rolls = form.file.only_without_roll && law.has_roll();
    form.file.needs.iter().all(everywhere)
        && !form.file.unless.iter().any(somewhere)
        && !rolls
        && form.missing_particular(&model.particulars).is_none()
}

/// Prepares a search.
///
/// # Errors
/// Returns an error that names what the model or a trial lacks.
pub(super) fn prepare_search<'a>(
    request: &DiagnosisInputs<'a>,
) -> Result<HypothesisSearch<'a>, RefineError> {
    let listed = listed_candidates(request.model, request.law, request.effects, request.trials);
    let (freed, changing) = (missing_term_candidates(request), changing_candidates(request));
    let terms: TermForms =
        learned_terms(request.model, request.law, request.effects, request.trials);
    let nuisance = model_columns(request.model, request.law);
    let (fixed, levels) = match &request.model.uncertainty {
        Some(uncertainty) => (
            learned_prior(uncertainty)?,
            THRESHOLDS.discrepancy.known_factors.map(known_level).to_vec(),
        ),
        None => (
            uncalibrated_prior(request.model, &nuisance, &terms, request.settings.slack),
            THRESHOLDS.discrepancy.unknown_factors.map(unknown_level).to_vec(),
        ),
    };
    let shift = fixed.expected_shift(&nuisance).ok_or_else(|| {
        RefineError::Law("its covariance of coefficients is not positive definite".into())
    })?;
    let mut search = HypothesisSearch {
        model: request.model,
        law: request.law,
        calibrated_model: CalibratedModel::new(
            request.model,
            request.law,
            &terms,
            &nuisance,
            &shift,
        )?,
        trials: request.trials,
        nuisance,
        terms,
        fixed: fixed.relative_to(&shift),
        calibrated_at_first: shift.clone(),
        calibrated: shift,
        expected: Vec::new(),
        levels,
        least_step_s: request.settings.least_step_s,
        log_priors: log_priors(request, &listed, &freed, &changing),
        states_odds: states_odds(request),
        history: request.settings.earlier.clone().unwrap_or_default(),
        steady: None,
        daily: daily_effects(request.effects),
        listed,
        freed,
        changing,
    };
    search.expected = expected_discrepancies(request, &search)?;
    Ok(search)
}

/// Adds a level of the discrepancy below that of the calibration, where an external influence is
/// recorded: part of the calibration's discrepancy may be due to it.
pub(super) fn with_level_below(mut search: HypothesisSearch<'_>) -> HypothesisSearch<'_> {
    if search.model.uncertainty.is_some() && search.listed.iter().any(is_external) {
        search.levels.insert(0, known_level(THRESHOLDS.discrepancy.factor_below));
    }
    search
}

fn known_level(factor: f64) -> DiscrepancyFactor {
    DiscrepancyFactor {
        factor,
        log_prior: -0.5 * (factor.ln() / THRESHOLDS.discrepancy.known_spread).powi(2),
    }
}

fn unknown_level(factor: f64) -> DiscrepancyFactor {
    DiscrepancyFactor { factor, log_prior: 0.0 }
}

/// Discrepancy of the model's calibration, or the least that is considered.
fn expected_discrepancies(
    request: &DiagnosisInputs<'_>,
    search: &HypothesisSearch<'_>,
) -> Result<AxisDiscrepancies, RefineError> {
    // Scales and axes alone are needed, so that the trials are not sampled.
    let columns = FilterColumns::default();
    let workspace =
        LinearisedTrials::new(&search.calibrated_model, columns, search.trials, Some(f64::MAX))?;
    let mut expected =
        workspace.motion_scales().level_discrepancies(THRESHOLDS.discrepancy.least_level);
    if let Some(uncertainty) = &request.model.uncertainty {
        for (axis, discrepancy) in workspace.axes().iter().zip(&mut expected) {
            if let Some(known) = uncertainty.discrepancy.get(axis) {
                *discrepancy = *known;
            }
        }
    }
    Ok(expected)
}
