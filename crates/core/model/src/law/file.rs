//! Structure of a law's YAML file.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::source::Source;

/// A law as its file writes it; see `models/laws/README.md`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawFile {
    /// Always `law`.
    pub kind: LawKind,
    /// Name in the zoo: lower case, digits, hyphens.
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// Publications by key.
    pub sources: BTreeMap<String, Source>,
    /// Inputs of the law: `delta`, `n`, `depth`, ...
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, InputFile>")]
    pub inputs: IndexMap<String, InputFile>,
    /// Nonlinear parameters.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, ParameterFile>")]
    pub parameters: IndexMap<String, ParameterFile>,
    /// Intermediate values, each a formula of earlier ones.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub values: IndexMap<String, String>,
    /// Meaning of each factor of a coefficient's name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub factors: IndexMap<String, String>,
    /// Conditions under which every coefficient deviates; the first one whose comparisons all hold
    /// applies.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, SubmodelFile>")]
    pub submodels: IndexMap<String, SubmodelFile>,
    /// The right-hand sides by axis.
    pub axes: BTreeMap<Axis, AxisFile>,
    /// The mass matrix: axis, then the axis whose acceleration it multiplies.
    pub mass: BTreeMap<Axis, BTreeMap<Axis, String>>,
    /// Rates of `x`, `y`, `psi`, `phi` where they are not those of motion in the horizontal plane.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub kinematics: BTreeMap<String, String>,
    /// Typical values of coefficients with their spread over ships, the prior of a model without a
    /// source.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, CoefficientPriorFile>")]
    pub typical: IndexMap<String, CoefficientPriorFile>,
    /// Transformation of parameters and inputs when the ship is mirrored: another name, or `-name`
    /// for the opposite.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub mirrors: BTreeMap<String, String>,
}

/// The word `law`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LawKind {
    /// The only one.
    Law,
}

/// An input as its file writes it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputFile {
    /// Its unit.
    pub unit: String,
    /// Default value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub default: Option<f64>,
    /// Value in manoeuvres, a formula of the ordered helm `delta` (rad) and revolutions `n` (1/s),
    /// for an input that is one actuator of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub helm: Option<String>,
}

/// A parameter as its file writes it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterFile {
    /// Its unit; `1` for a pure number.
    pub unit: String,
    /// Its meaning.
    pub meaning: String,
    /// Formula of particulars from which it follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// `approach_speed` for the speed about which the law is expanded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<ParameterRole>,
    /// Prior by which trials determine it; without one it keeps the source's value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<ParameterPrior>,
}

/// Typical value of a coefficient as its file writes it. Formulas may use particulars and the
/// approach of the trials, `approach_speed_m_s` and `approach_revolutions_rps`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoefficientPriorFile {
    /// Formula of the typical value.
    pub value: String,
    /// Formula of the standard deviation over ships.
    pub deviation: String,
}

/// Prior of a parameter that trials determine: how ships differ, and what is physically possible.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterPrior {
    /// Value of a ship without a source that has the parameter.
    pub value: f64,
    /// Standard deviation about the source's value.
    pub deviation: f64,
    /// Least and greatest physical value.
    pub range: [f64; 2],
}

impl ParameterPrior {
    /// Returns true if the deviation is positive and the value lies within the range.
    pub fn is_consistent(&self) -> bool {
        let [low, high] = self.range;
        let is_finite = [self.value, self.deviation, low, high].into_iter().all(f64::is_finite);
        is_finite && self.deviation > 0.0 && low < self.value && self.value < high
    }
}

/// Special meaning of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ParameterRole {
    /// The speed about which the law is expanded.
    ApproachSpeed,
}

/// A submodel as its file writes it: the coefficient `X_u@name` is added to `X_u` while its
/// comparisons hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SubmodelFile {
    /// Comparisons such as `u < 0`, all of which must hold.
    pub when: Vec<String>,
    /// Its meaning.
    pub meaning: String,
    /// Precision (the inverse variance) of the prior that shrinks a deviation to zero, relative to
    /// that of the shared coefficient's prior.
    #[serde(default = "no_shrinkage")]
    pub shrinkage: f64,
}

fn no_shrinkage() -> f64 {
    1.0
}

/// One axis as its file writes it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisFile {
    /// Factor of every term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<String>,
    /// Coefficients: a name alone means the product of its factors, `{name: formula}` means that
    /// formula.
    #[serde(default)]
    pub terms: Vec<TermFile>,
    /// Force without coefficients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<String>,
    /// True if a vessel may add further terms that the factors can express.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub open: bool,
}

/// One term as its file writes it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TermFile {
    /// The product of the factors in the name.
    Name(String),
    /// A regressor with its own formula.
    Formula(BTreeMap<String, String>),
}
