//! Structure of an effect's YAML file.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::source::Source;
use crate::trial::Channel;

/// An effect as its file writes it; see `models/effects/README.md`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectFile {
    /// Always `effect`.
    pub kind: EffectKind,
    /// Name in the zoo: lower case, digits, hyphens.
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// The part of the model on which it acts.
    pub acts_on: ActsOn,
    /// Publications by key.
    pub sources: BTreeMap<String, Source>,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Prior odds of the effect, before any trial is considered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beforehand: Option<PriorOddsFile>,
    /// True if it differs from day to day, as weather does: earlier trials of the ship do not
    /// inform on it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub differs_by_day: bool,
    /// The forms in which it may appear; each is fitted to trials that have the channels it needs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<FormFile>,
    /// Instead of forms: a grammar of terms that are searched one by one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grammar: Option<GrammarFile>,
}

/// Odds that new trials show an effect that the model lacks, against that they do not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PriorOddsFile {
    /// Odds of all forms together.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub odds: f64,
    /// The same for trials that record the cause, such as the wind: for forms that need such a
    /// channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub odds_where_recorded: Option<f64>,
    /// Basis of the odds.
    pub because: String,
}

/// The word `effect`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum EffectKind {
    /// The only one.
    Effect,
}

/// The part of the model on which an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActsOn {
    /// It adds forces and moments.
    Force,
    /// It changes the inflow to the hull or an actuator.
    Inflow,
    /// It changes the readings of the instruments.
    Measurement,
}

/// One form of an effect, as in its file and in a model that has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormFile {
    /// Name that distinguishes it from the other forms of the effect, such as `measured`.
    pub name: String,
    /// One line for readers.
    pub meaning: String,
    /// Channels that every trial must have.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub needs: Vec<Channel>,
    /// Channels of which no trial may have any: another form applies where they are recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unless: Vec<Channel>,
    /// True if the form is meant only for laws without roll.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub only_without_roll: bool,
    /// True if the form is fitted only as a change within a trial: a constant one cannot be
    /// distinguished from the coefficients.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub only_as_change: bool,
    /// Difference between forms of the effect by different authors: root mean square of the
    /// difference relative to that of the response, with the best ratio of sizes. Default: a few
    /// per cent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
    pub misfit: Option<f64>,
    /// Particulars it uses, with the formula that replaces one that the ship does not state.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub particulars: IndexMap<String, String>,
    /// Parameters that are fitted.
    #[schemars(with = "BTreeMap<String, EffectParameterFile>")]
    pub parameters: IndexMap<String, EffectParameterFile>,
    /// Figures that are reported besides the parameters, each a formula of them.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub reports: IndexMap<String, String>,
    /// Intermediate values, each a formula of earlier ones.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub values: IndexMap<String, String>,
    /// Formulas that replace a state or an input in the law.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub sees: IndexMap<String, String>,
    /// Additions to the accelerations of the law, m/s2 or rad/s2.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub accelerates: BTreeMap<Axis, String>,
    /// Factors on coefficients of the law, by name; coefficients that the law does not have are
    /// ignored.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub coefficients: IndexMap<String, String>,
    /// Inputs that act through a first-order lag, with its time constant, s.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub lags: IndexMap<String, String>,
    /// Inputs with a dead band, with half of its width in the unit of the input.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub bands: IndexMap<String, String>,
    /// Added forces in N and moments in N m.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub forces: BTreeMap<Axis, String>,
    /// Readings of an instrument, as a formula of the true state.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measures: BTreeMap<Channel, String>,
}

/// A parameter of an effect as its file writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectParameterFile {
    /// Its unit: SI and radians; `1` for a pure number.
    pub unit: String,
    /// Its meaning.
    pub meaning: String,
    /// Its prior before any trial: a normal distribution.
    pub prior: PriorFile,
    /// Least and greatest value that is plausible.
    pub bounds: [f64; 2],
    /// The value that represents the absence of the effect.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub absent: f64,
    /// Initial value of a search; default: the absence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
    /// True if it is a coefficient of the form, in which authors differ by its prior, not a size of
    /// the effect: trials that move all of these far from their priors show something else.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shape: bool,
    /// Its transformation when the ship is mirrored port to starboard.
    pub mirror: Mirror,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The prior of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PriorFile {
    /// Mean.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// Transformation of a parameter when the ship is mirrored port to starboard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mirror {
    /// It keeps its value.
    Same,
    /// It changes its sign.
    Opposite,
}

/// Terms that are searched one by one: products of factors, each one a form with a single
/// parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrammarFile {
    /// Meaning of the factors, each a dimensionless formula.
    #[schemars(with = "BTreeMap<String, String>")]
    pub factors: IndexMap<String, String>,
    /// Factors whose absolute value may follow, as in `v|v|`.
    #[serde(default)]
    pub absolute: Vec<String>,
    /// Largest number of factors in a term.
    pub order: usize,
    /// Force in N (moment in N m) of a term with a coefficient and factors of one.
    pub scales: BTreeMap<Axis, String>,
    /// Standard deviation of the prior of a coefficient, by axis.
    pub deviations: BTreeMap<Axis, f64>,
}
