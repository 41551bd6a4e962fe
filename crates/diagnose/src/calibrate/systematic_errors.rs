//! What instruments do wrong on the trials that a model was fitted on. Later trials are read by the
//! same ones: an error that was there before is not new, and left alone it would hide what is.

use sistership_model::Model;
use sistership_model::effect::{ActsOn, AppliedEffect};
use sistership_model::uncertainty::Uncertainty;

use super::super::Request;
use super::super::choose::choose;
use super::super::setup::search;
use super::super::values::{acts_on, model_with};
use sistership_estimate::refine::RefineError;

/// Errors of instruments that have one size on all trials; none where the instruments agree.
pub(super) fn of(
    request: &Request<'_>,
    known: &Uncertainty,
) -> Result<Vec<AppliedEffect>, RefineError> {
    // False-alarm levels are not yet to be asked: an effect may be there.
    let known = Uncertainty { false_alarm_levels: Default::default(), ..known.clone() };
    let model = &Model { uncertainty: Some(known), ..request.model.clone() };
    let mut search = search(&Request { model, ..*request })?;
    search.freed.clear();
    search.listed.retain(|candidate| acts_on(candidate) == ActsOn::Measurement);
    let choice = choose(&search, request.settings)?;
    Ok(model_with(search.model, &choice.best().candidates, None)
        .effects
        .split_off(model.effects.len()))
}
