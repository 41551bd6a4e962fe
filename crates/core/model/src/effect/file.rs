//! The shape of an effect's YAML file.

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
    /// One line for people.
    pub title: String,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// Publications by key.
    pub sources: BTreeMap<String, Source>,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// How common it is, before any trial is looked at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beforehand: Option<PriorOddsFile>,
    /// The forms in which it may appear; each is tried on trials that have the channels it needs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<FormFile>,
    /// Instead of forms: terms that are searched for one by one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grammar: Option<GrammarFile>,
}

/// Odds that new trials have an effect which the model lacks, against that they do not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PriorOddsFile {
    /// In all forms together.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub odds: f64,
    /// The same where trials record the cause, such as the wind: for forms that need such a
    /// channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub odds_where_recorded: Option<f64>,
    /// What they come from.
    pub because: String,
}

/// The word `effect`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum EffectKind {
    /// The only one.
    Effect,
}

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActsOn {
    /// It adds forces and moments.
    Force,
    /// It changes what the hull or an actuator sees.
    Inflow,
    /// It changes what the instruments say.
    Measurement,
}

/// One form of an effect as its file, and a model that carries it, write it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormFile {
    /// What tells it from the other forms of the effect, such as `measured`.
    pub name: String,
    /// One line for people.
    pub meaning: String,
    /// Channels that every trial must have.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub needs: Vec<Channel>,
    /// Channels of which no trial may have any: where they are recorded, another form is meant.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unless: Vec<Channel>,
    /// Whether the form is meant only for laws without roll.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub only_without_roll: bool,
    /// Whether the form is tried as a change within a trial only: throughout, it is what
    /// coefficients say.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub only_as_change: bool,
    /// How far one author's form of it is from another's: root mean square of the difference by
    /// that of the response, where the sizes suit each other best. Where absent, a few per cent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
    pub misfit: Option<f64>,
    /// Particulars it uses, with what stands in where the ship does not state them.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub particulars: IndexMap<String, String>,
    /// What is fitted.
    #[schemars(with = "BTreeMap<String, EffectParameterFile>")]
    pub parameters: IndexMap<String, EffectParameterFile>,
    /// What is reported besides the parameters, each a formula of them.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub reports: IndexMap<String, String>,
    /// Intermediate values, each a formula of earlier ones.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub values: IndexMap<String, String>,
    /// What the law sees in place of a state or an input.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub sees: IndexMap<String, String>,
    /// What is added to the accelerations that the law gives, m/s2 or rad/s2.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub accelerates: BTreeMap<Axis, String>,
    /// Factors on coefficients of the law, by name; coefficients that the law does not have are
    /// passed over.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub coefficients: IndexMap<String, String>,
    /// Inputs that reach the ship through a first-order lag, with its time constant, s.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub lags: IndexMap<String, String>,
    /// Inputs that the ship follows only where they leave a band about what it has, with half of
    /// the band's width in the unit of the input.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub bands: IndexMap<String, String>,
    /// Forces in N and moments in N m that are added.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub forces: BTreeMap<Axis, String>,
    /// What an instrument says, as a formula of the true state.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measures: BTreeMap<Channel, String>,
}

/// A parameter of an effect as its file writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectParameterFile {
    /// Its unit: SI and radians; `1` for a pure number.
    pub unit: String,
    /// What it means.
    pub meaning: String,
    /// What is believed of it before any trial: a normal distribution.
    pub prior: PriorFile,
    /// The least and the greatest value that is believed at all.
    pub bounds: [f64; 2],
    /// The value that stands for the absence of the effect.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub absent: f64,
    /// Where a search begins, if not at its absence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
    /// Whether it is a coefficient of the form, in which authors differ by its prior, and no size
    /// of the effect: trials that push all of these far out show something else.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shape: bool,
    /// What it becomes when the ship is mirrored port to starboard.
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

/// What a parameter becomes when the ship is mirrored port to starboard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mirror {
    /// It stays.
    Same,
    /// It changes its sign.
    Opposite,
}

/// Terms that are searched for one by one: products of factors, each one a form with a single
/// parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrammarFile {
    /// What the factors stand for, each a dimensionless formula.
    #[schemars(with = "BTreeMap<String, String>")]
    pub factors: IndexMap<String, String>,
    /// Factors of which the absolute value may follow, as in `v|v|`.
    #[serde(default)]
    pub absolute: Vec<String>,
    /// Most factors in a term.
    pub order: usize,
    /// Force in N (moment in N m) of a term with coefficient and factors of one.
    pub scales: BTreeMap<Axis, String>,
    /// Standard deviation of a coefficient's prior, by axis.
    pub deviations: BTreeMap<Axis, f64>,
}
