//! Settings of a diagnosis.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::effect_history::EffectHistory;

/// Settings of a diagnosis; all are stored with its report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "DiagnosisSettings")]
pub struct Settings {
    /// Interval between restarts of the simulations that judge, s. Default: ten times the time in
    /// which the ship covers its length.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub restart_s: Option<f64>,
    /// Shortest interval between samples that are used, s. Default: a fiftieth of the time in which
    /// the ship covers its length.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub least_step_s: Option<f64>,
    /// Relative error of a published coefficient, as a share of its value, for a model without the
    /// uncertainty of its own trials.
    #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
    pub slack: f64,
    /// Least evidence (natural logarithm, including the cost of the number of hypotheses) for an
    /// effect to be named.
    #[schemars(range(min = 0))]
    pub least_evidence: f64,
    /// Largest number of effects that are named together.
    #[schemars(range(min = 1, max = 4))]
    pub most_effects: usize,
    /// Prior odds that trials have an effect, by its name. Default: those of the library.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub prior_odds: BTreeMap<String, f64>,
    /// Information of earlier trials of the ship: the `history` of its last diagnosis.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub earlier: Option<EffectHistory>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            restart_s: None,
            least_step_s: None,
            slack: 0.02,
            least_evidence: 5.0,
            most_effects: 3,
            prior_odds: BTreeMap::new(),
            earlier: None,
        }
    }
}

impl Settings {
    /// Checks the values.
    ///
    /// # Errors
    /// Returns the field and its allowed values if one is invalid.
    pub fn check_values(&self) -> Result<(), (String, String)> {
        let refuse = |field: &str, message: &str| Err((field.to_owned(), message.to_owned()));
        let positive =
            |value: Option<f64>| value.is_none_or(|value| value > 0.0 && value.is_finite());
        if !positive(self.restart_s) {
            return refuse("restart_s", "must be above 0 s");
        }
        if !positive(self.least_step_s) {
            return refuse("least_step_s", "must be above 0 s");
        }
        if !(self.slack > 0.0 && self.slack <= 1.0) {
            return refuse("slack", "must be above 0 and at most 1");
        }
        if !(self.least_evidence >= 0.0 && self.least_evidence.is_finite()) {
            return refuse("least_evidence", "must be at least 0");
        }
        if !(1..=4).contains(&self.most_effects) {
            return refuse("most_effects", "must be from 1 to 4");
        }
        let wrong = |odds: &f64| !(*odds > 0.0 && odds.is_finite());
        if let Some((name, _)) = self.prior_odds.iter().find(|(_, odds)| wrong(odds)) {
            return refuse("prior_odds", &format!("of `{name}` must be above 0"));
        }
        let earlier = self.earlier.as_ref().map_or(Ok(()), EffectHistory::check_values);
        if let Err(message) = earlier {
            return refuse("earlier", &message);
        }
        Ok(())
    }
}
