//! Trials corrected for the errors of their instruments, as records of the ship's motion for a
//! regression.

use std::borrow::Cow;

use sistership_model::effect::{ActsOn, AppliedEffect, TIME_INPUT};
use sistership_model::{Model, Trial};
use sistership_simulation::recorded::correct_instrument_errors;

use super::DiagnosisInputs;
use sistership_priors::transfer::prepare_ship;

pub(super) struct CorrectedRecords<'a>(Vec<Cow<'a, Trial>>);

impl<'a> CorrectedRecords<'a> {
    /// Corrects the trials of a request for the errors of a model's instruments. Returns none where
    /// the model has no effect on the ship, or one that changes with time, which a regression
    /// cannot include.
    pub fn new(request: &DiagnosisInputs<'a>, model: &Model) -> Option<Self> {
        let (ship, instruments) = split_effects(model);
        let law = request.law.with_effects(&ship).ok()?;
        if ship.effects.is_empty() || law.inputs.contains_key(TIME_INPUT) {
            return None;
        }
        if instruments.is_empty() {
            return Some(Self(request.trials.iter().map(|trial| Cow::Borrowed(*trial)).collect()));
        }
        let erring = prepare_ship(
            &Model { effects: instruments, ..model.clone() },
            request.law,
            request.trials,
        )
        .ok()?;
        // An instrument model may diverge on a record; then no trial is corrected.
        let right = |trial: &&Trial| {
            correct_instrument_errors(&erring, trial).ok().filter(is_finite).map(Cow::Owned)
        };
        request.trials.iter().map(right).collect::<Option<_>>().map(Self)
    }

    pub fn trials(&self) -> Vec<&Trial> {
        self.0.iter().map(Cow::as_ref).collect()
    }
}

fn is_finite(trial: &Trial) -> bool {
    trial.channels.values().flatten().all(|value| value.is_finite())
}

/// Splits a model into one with its effects on the ship, and its effects on instruments.
pub(super) fn split_effects(model: &Model) -> (Model, Vec<AppliedEffect>) {
    let (instruments, effects) =
        model.effects.iter().cloned().partition(|effect| effect.acts_on == ActsOn::Measurement);
    (Model { effects, ..model.clone() }, instruments)
}

/// Joins a model with its effects on the ship and its effects on instruments.
pub(super) fn join_effects(mut ship: Model, instruments: Vec<AppliedEffect>) -> Model {
    ship.effects.extend(instruments);
    ship
}
