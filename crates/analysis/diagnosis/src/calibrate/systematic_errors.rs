//! Systematic errors of instruments on the trials on which a model was fitted. Later trials are
//! recorded by the same instruments: an error that was already present is not new, and if ignored
//! it would hide what is new.

use std::sync::Arc;

use sistership_model::effect::{ActsOn, AppliedEffect};
use sistership_model::law::Law;
use sistership_model::uncertainty::Uncertainty;
use sistership_model::{Effect, Model, Trial};

use super::super::choose::choose_effects;
use super::super::screening::screen_effects;
use super::super::search::HypothesisSearch;
use super::super::setup::prepare_search;
use super::super::thresholds::THRESHOLDS;
use super::super::values::{form_target, model_with_effects};
use super::super::{DiagnosisInputs, Settings};
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// Errors of instruments that have one size on all trials; empty where the instruments agree.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn find_systematic_errors(
    model: &Model,
    known: &Uncertainty,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Result<Vec<AppliedEffect>, RefineError> {
    // False-alarm levels are not applied yet: the effect may be present on these trials.
    let known = Uncertainty { false_alarm_levels: Default::default(), ..known.clone() };
    let model = Model { uncertainty: Some(known), ..model.clone() };
    let settings = Settings {
        least_evidence: THRESHOLDS.calibration.systematic_error_evidence,
        ..Settings::default()
    };
    let request = DiagnosisInputs { model: &model, law, effects, trials, settings: &settings };
    let mut search = prepare_search(&request)?;
    search.freed.clear();
    // Detection limits are not needed here.
    search.states_odds = false;
    // Only effects on measurements are candidates.
    search.listed.retain(|candidate| form_target(candidate) == ActsOn::Measurement);
    let seeming = apparent_errors(&search)?;
    if seeming.is_empty() {
        return Ok(Vec::new());
    }
    search.listed = seeming;
    let base = search.filter_with_candidates(&[], &search.levels)?;
    let choice = choose_effects(&search, &base, &settings)?;
    // Only the effects that the search has added to those of the model.
    Ok(model_with_effects(search.model, &choice.best_hypothesis().candidates, None)
        .effects
        .split_off(model.effects.len()))
}

/// Errors that one linearisation shows, at the discrepancy of the trials: most instruments agree,
/// and a search over sets and levels would find that at ten times the cost.
fn apparent_errors(search: &HypothesisSearch<'_>) -> Result<Vec<EffectCandidate>, RefineError> {
    // At the least level, that of the trials themselves, an error has the most evidence.
    let least_level = search.levels.iter().min_by(|a, b| a.factor.total_cmp(&b.factor)).copied();
    let base = search.filter_with_candidates(&[], least_level.as_slice())?;
    let least =
        THRESHOLDS.calibration.seeming_share * THRESHOLDS.calibration.systematic_error_evidence;
    let seeming =
        screen_effects(search, &base)?.into_iter().filter(|likely| likely.discounted >= least);
    Ok(seeming.map(|likely| likely.candidate).collect())
}
