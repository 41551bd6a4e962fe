//! Request of a trial design.

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

use crate::error::PlanError;
use crate::instruments::InstrumentAccuracy;
use crate::thresholds::THRESHOLDS;

/// Inputs of a trial design.
#[derive(Debug, Clone, Copy)]
pub struct PlanRequest<'a> {
    /// Model, with its present uncertainty.
    pub model: &'a Model,
    /// Law of the model, without effects.
    pub law: &'a Law,
    /// Library of effects.
    pub library: &'a [Arc<Effect>],
    /// Time for all trials, with their approaches, s.
    pub budget_s: f64,
    /// Names of effects to be distinguished.
    pub apart: &'a [String],
    /// Trials that are recorded already and on which the model was not fitted: new ones are
    /// recorded like the first of these.
    pub sailed: &'a [&'a Trial],
    /// Instruments of planned trials, where none is recorded yet.
    pub instruments: InstrumentAccuracy,
}

impl PlanRequest<'_> {
    /// Checks the budget and the names of the effects.
    ///
    /// # Errors
    /// Returns an error for a budget out of range, or an effect that the library does not have.
    pub fn check_inputs(&self) -> Result<(), PlanError> {
        if !(self.budget_s > 0.0 && self.budget_s <= THRESHOLDS.longest_budget_s) {
            return Err(PlanError::Budget);
        }
        let known = |name: &str| self.library.iter().any(|effect| effect.name == name);
        match self.apart.iter().find(|name| !known(name)) {
            Some(name) => Err(PlanError::Effect {
                name: name.clone(),
                known: self.library.iter().map(|effect| effect.name.clone()).collect(),
            }),
            None => Ok(()),
        }
    }
}
