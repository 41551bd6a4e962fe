//! Effect of a model.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::file::{ActsOn, FormFile};
use super::form::EffectForm;
use crate::quantity::Quantity;

/// Effect of a model: its definition and the values of its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AppliedEffect {
    /// The effect's name.
    pub name: String,
    /// The part of the model on which it acts.
    pub acts_on: ActsOn,
    /// Values of its parameters.
    pub parameters: BTreeMap<String, Quantity>,
    /// The form as its file defines it, so that the model does not depend on the library of
    /// effects.
    pub form: FormFile,
}

impl AppliedEffect {
    /// Reads the form and checks that each parameter has a value.
    ///
    /// # Errors
    /// Returns the field at fault and the reason.
    pub fn checked_form(&self) -> Result<EffectForm, (String, String)> {
        let form = EffectForm::from_file(self.acts_on, &self.form)?;
        // Every parameter of the form must have a finite value, and there must be no other.
        for name in form.parameters.keys() {
            if !self.parameters.get(name).is_some_and(|quantity| quantity.value.is_finite()) {
                return Err((format!("parameters.{name}"), "give it a finite value".into()));
            }
        }
        match self.parameters.keys().find(|name| !form.parameters.contains_key(*name)) {
            Some(name) => {
                Err((format!("parameters.{name}"), "the effect has no such parameter".into()))
            }
            None => Ok(form),
        }
    }
}
