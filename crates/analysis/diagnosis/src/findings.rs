//! Statements of a diagnosis: on the effects found, on all hypotheses that were judged, and on the
//! method.

use std::collections::BTreeMap;

use sistership_model::Model;
use sistership_model::quantity::Quantity;

use super::DiagnosisInputs;
use super::choose::{ConvergedChoice, EffectChoice};
use super::confounded::EffectResponses;
use super::covariance::effect_covariance;
use super::hypothesis::JudgedHypothesis;
use super::next_trial::propose_next_trial;
use super::outcome::{
    HypothesisReport, MissingEffect, NextTrial, RemainderPattern, ValueWithError,
};
use super::search::HypothesisSearch;
use super::values::{form_target, own_covariance, values_with_errors};
use sistership_identification::refine::RefineError;

/// Effects found with those they are confounded with, the strongest first, and the trial that would
/// separate them.
pub(super) fn found_with_confounded(
    request: &DiagnosisInputs<'_>,
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
    of_all: f64,
) -> Result<(Vec<MissingEffect>, Option<NextTrial>), RefineError> {
    let mut all: Vec<MissingEffect> = (0..best.candidates.len())
        .map(|place| report_effect(request, search, best, place, of_all))
        .collect::<Result<_, _>>()?;
    let mut next = None;
    if !all.is_empty() {
        // Filtered again at the final estimates, at the level of the hypothesis alone.
        let level = best.level.min(search.levels.len() - 1);
        let base =
            search.filter_with_candidates(&best.candidates, &search.levels[level..=level])?;
        let (columns, others) =
            (base.workspace.columns(), search.other_candidates(&best.candidates));
        let responses =
            EffectResponses::new(search, columns, best, (others, &base.total_products(0)))?;
        for (place, found) in all.iter_mut().enumerate() {
            found.confounded_with = responses.confounded_with(place);
        }
        next = propose_next_trial(search, &base, best, &all)?;
    }
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    Ok((all, next))
}

/// Report of an effect. `of_all` is the evidence of all effects together where the model alone may
/// have any discrepancy: no single one has more.
fn report_effect(
    request: &DiagnosisInputs<'_>,
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
    place: usize,
    of_all: f64,
) -> Result<MissingEffect, RefineError> {
    let candidate = &best.candidates[place];
    let discount = search.candidate_discount(candidate);
    let covariance = effect_covariance(best, place, (&search.nuisance, &search.fixed), discount);
    Ok(MissingEffect {
        name: candidate.effect.clone(),
        form: candidate.form.file.name.clone(),
        meaning: candidate.form.file.meaning.clone(),
        acts_on: form_target(candidate),
        parameters: values_with_errors(candidate, &covariance, request.model),
        evidence: search.effect_evidence(best, place)?.min(of_all),
        in_model: BTreeMap::new(),
        confounded_with: Vec::new(),
    })
}

/// Parameters of an effect in a model, where they differ from those found.
pub(super) fn refitted_parameters(
    found: &MissingEffect,
    model: &Model,
) -> BTreeMap<String, ValueWithError> {
    let carried =
        model.effects.iter().find(|own| own.name == found.name && own.form.name == found.form);
    let all = carried.into_iter().flat_map(|own| &own.parameters);
    let moved = all.clone().any(|(name, own)| {
        found.parameters.get(name).is_some_and(|value| value.value != own.value)
    });
    let one = |(name, own): (&String, &Quantity)| {
        (name.clone(), ValueWithError { value: own.value, se: own.standard_error.unwrap_or(0.0) })
    };
    if moved { all.map(one).collect() } else { BTreeMap::new() }
}

/// Returns the hypotheses that were judged at their estimates, the most probable first: the one with
/// the effects of the result is marked, and the others have the reason for which they are not.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn report_hypotheses(
    request: &DiagnosisInputs<'_>,
    settled: &ConvergedChoice<'_>,
    choice: &EffectChoice,
) -> Result<Vec<HypothesisReport>, RefineError> {
    let fixed = &settled.search.fixed;
    let alone = choice.alone.held_out_log_probability(fixed)?;
    let has_effects = !settled.best.candidates.is_empty();
    let one = |judged: &JudgedHypothesis| {
        let taken = has_effects && judged.has_same_effects(&settled.best);
        Ok(HypothesisReport {
            effects: judged.candidate_keys(),
            evidence: judged.log_evidence - choice.alone.log_evidence,
            held_out: Some(judged.held_out_log_probability(fixed)? - alone),
            parameters: hypothesis_parameters(request, judged),
            taken,
            refused: (!taken).then(|| refusal_reason(settled, choice, judged)),
        })
    };
    // A set of which effects were removed at the end may not have been judged before.
    let is_new = choice.tried.iter().all(|tried| !tried.has_same_effects(&settled.best));
    let last = (is_new && has_effects).then_some(&settled.best);
    let mut all: Vec<HypothesisReport> =
        choice.tried.iter().chain(last).map(one).collect::<Result<_, RefineError>>()?;
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    Ok(all)
}

/// Reason for which a hypothesis is not the result.
fn refusal_reason(
    settled: &ConvergedChoice<'_>,
    choice: &EffectChoice,
    judged: &JudgedHypothesis,
) -> String {
    if let Some(refusal) = &judged.refusal {
        return refusal.to_string();
    }
    let accepted = choice.taken.map(|taken| &choice.tried[taken]);
    if accepted.is_some_and(|accepted| accepted.has_same_effects(judged)) {
        // It was accepted, and lost effects when the coefficients were fitted together with it.
        let reasons = settled.removed.iter().map(|(name, refusal)| {
            format!("`{name}` was removed after the coefficients were fitted with it: {refusal}")
        });
        return reasons.collect::<Vec<_>>().join("; ");
    }
    let names: Vec<String> =
        settled.best.candidates.iter().map(|one| format!("`{}`", one.effect)).collect();
    match names.is_empty() {
        true => "what it explains is a change within trials".to_owned(),
        false => format!("{} explains the trials better", names.join(" with ")),
    }
}

fn hypothesis_parameters(
    request: &DiagnosisInputs<'_>,
    judged: &JudgedHypothesis,
) -> BTreeMap<String, ValueWithError> {
    let of = |place: usize| {
        let covariance = own_covariance(&judged.candidates, place, &judged.covariance);
        values_with_errors(&judged.candidates[place], &covariance, request.model)
    };
    (0..judged.candidates.len()).flat_map(of).collect()
}

/// Description of the held-out trials; `refit` is the method by which the coefficients were fitted,
/// if they were.
pub(super) fn describe_method(request: &DiagnosisInputs<'_>, refit: Option<&str>) -> String {
    let fitted = match request.trials.len() {
        1 => "there is only one trial: these are errors on the trial that the effects were fitted \
             to"
        .to_owned(),
        count => format!("each of {count} trials is simulated with effects fitted to the others"),
    };
    match refit {
        Some(refit) => format!(
            "{fitted}; the coefficients were fitted again likewise, with the settings of the \
             least held-out error ({refit})"
        ),
        None => fitted,
    }
}

/// Remark on a pattern of the remainder.
pub(super) fn pattern_remark(pattern: &RemainderPattern) -> String {
    let variable = match (pattern.variable.as_str(), pattern.period_s) {
        ("psi", _) => "depends on the heading".to_owned(),
        ("t", _) => "depends on the time since the start of a trial".to_owned(),
        ("u", _) => "depends on the speed".to_owned(),
        ("delta", _) => "depends on the rudder angle".to_owned(),
        ("n", _) => "depends on the revolutions".to_owned(),
        (_, Some(period_s)) => format!("oscillates with a period of about {period_s:.0} s"),
        (other, None) => format!("depends on `{other}`"),
    };
    format!(
        "the residual of the acceleration `{}` {variable} (evidence {:.1}), although no single \
         segment of a trial exceeds the noise",
        pattern.channel, pattern.evidence
    )
}

/// Remarks on effects that were refused, and on the resulting model.
pub(super) fn collect_remarks(
    refused: &[String],
    is_better: bool,
    found: &[MissingEffect],
) -> Vec<String> {
    let one = |name: &String| {
        format!(
            "`{name}` would explain a part of the residual, but with sizes that differ between \
             trials: it only resembles the missing effect and is not reported"
        )
    };
    let worse = "the effects found do not reduce the errors on held-out trials: no new model is \
                 made";
    let together = |found: &MissingEffect| {
        format!(
            "in the new model, `{}` was fitted again together with the coefficients, by simulated \
             trials: its parameters there differ from those that the diagnosis estimates",
            found.name
        )
    };
    let together = found.iter().filter(|found| !found.in_model.is_empty()).map(together);
    refused.iter().map(one).chain((!is_better).then(|| worse.to_owned())).chain(together).collect()
}
