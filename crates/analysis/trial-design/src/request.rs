//! What is asked for.

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

use crate::error::PlanError;
use crate::instruments::Instruments;
use crate::thresholds::THRESHOLDS;

/// What a plan is asked for.
#[derive(Debug, Clone, Copy)]
pub struct PlanRequest<'a> {
    /// The model as it is known so far.
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// The library of effects.
    pub library: &'a [Arc<Effect>],
    /// Time for all trials, with their approaches, s.
    pub budget_s: f64,
    /// Effects that are to be told apart, by name.
    pub apart: &'a [String],
    /// Trials that were sailed already and that the model was not fitted on: new ones are recorded
    /// as the first of these.
    pub sailed: &'a [&'a Trial],
    /// What will read them, where none was sailed.
    pub instruments: Instruments,
}

impl PlanRequest<'_> {
    /// Refuses a budget that is no time, and effects that the library does not have.
    ///
    /// # Errors
    /// Says which.
    pub fn check(&self) -> Result<(), PlanError> {
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
