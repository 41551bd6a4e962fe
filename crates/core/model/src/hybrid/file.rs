//! Structure of a declaration's YAML file.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::law::SubmodelFile;
use crate::source::Source;

/// A declaration of an Abkowitz-MMG hybrid as its file writes it; see `models/hybrids/README.md`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HybridFile {
    /// Always `hybrid`.
    pub kind: HybridKind,
    /// Name of the law: lower case, digits, hyphens.
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// Publications by key, in addition to that of the hybrid itself.
    #[serde(default)]
    pub sources: BTreeMap<String, Source>,
    /// Highest degree of the polynomials, 1 to 4.
    pub order: u32,
    /// Units of the coefficients.
    #[serde(default)]
    pub scaling: Scaling,
    /// The actuators by name.
    #[schemars(with = "BTreeMap<String, ActuatorFile>")]
    pub actuators: IndexMap<String, ActuatorFile>,
    /// Selection and notation of the terms of the expansion.
    #[serde(default)]
    pub rules: Rules,
    /// Conditions under which coefficients deviate.
    #[serde(default)]
    pub submodels: SubmodelsFile,
    /// Precision of a deviation's prior relative to that of a shared coefficient's prior.
    #[serde(default = "default_shrinkage")]
    pub shrinkage: f64,
    /// Effects used with the law; they are not part of it, but their parameters are unknowns too.
    #[serde(default)]
    pub effects: Vec<EffectUse>,
}

fn default_shrinkage() -> f64 {
    4.0
}

/// The word `hybrid`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HybridKind {
    /// The only one.
    Hybrid,
}

/// Units of the coefficients.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// Forces in N of velocities in SI, as Miyauchi 2024, Idea 6: coefficients belong to one ship.
    Dimensional,
    /// The bis system: mass, Lpp and g as units, so that coefficients are transferred by Froude's
    /// law and are defined at rest, too.
    #[default]
    Bis,
}

/// One actuator, or a pair of them.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActuatorFile {
    /// Kind of the actuator.
    pub kind: ActuatorKind,
    /// True if there is one on either side, `NAME_s` and `NAME_p`; a VecTwin is always a pair.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub pair: bool,
    /// Form in which an angle enters the expansion.
    #[serde(default)]
    pub angle: AngleFeature,
    /// Nominal stall angle of a rudder, deg: one, or starboard and port.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stall_deg: Option<StallFile>,
    /// Variables by which its terms are multiplied.
    #[serde(default)]
    pub couples: Coupling,
    /// Axes on which it acts; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<Vec<Axis>>,
}

/// Kinds of actuators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ActuatorKind {
    /// A propeller: its revolutions.
    Propeller,
    /// A rudder: its angle.
    Rudder,
    /// Two rudders behind one propeller, each with its own angle.
    Vectwin,
    /// A thruster that turns: revolutions `n_NAME` and angle `NAME`.
    Azimuth,
    /// A thruster across the ship: its revolutions, positive for a force to starboard.
    TunnelThruster,
}

/// Form in which an angle enters the expansion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AngleFeature {
    /// Sine and cosine: Miyauchi 2024, Eq. 6.
    #[default]
    SineCosine,
    /// Sine and 1 - cos, so that a rudder amidships adds nothing to a ship at rest.
    SineVersine,
    /// The angle itself, as Abkowitz.
    Plain,
}

/// A stall angle, or one for each side.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum StallFile {
    /// Angle of one rudder, or of both, deg.
    Both(f64),
    /// Angle of each side, deg.
    Sides {
        /// Starboard rudder.
        starboard: f64,
        /// Port rudder.
        port: f64,
    },
}

/// Variables by which an actuator's terms are multiplied.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// The ship's motion and every other actuator.
    #[default]
    All,
    /// The ship's motion only: its flow meets no other actuator.
    Hull,
    /// None.
    None,
}

/// Selection and notation of the terms: Miyauchi 2024, sec. 2.2.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rules {
    /// Keep the force at rest, the first term of Eq. 7.
    pub constant: bool,
    /// Modification A: selection by port/starboard symmetry.
    pub symmetry: Symmetry,
    /// Keep in Y and N the terms without a factor that is odd in the mirror, such as `Y_n`: the
    /// bias of a single screw.
    pub zeroth_powers: bool,
    /// Replace `v^2`, which modification A removes, by `v|v|`: cross-flow drag.
    pub signed_squares: bool,
    /// Modification B: drop powers of sines and cosines.
    pub trigonometric_powers: TrigonometricPowers,
    /// Exceptions from modification B.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub trigonometric_exceptions: Vec<ExceptionFile>,
    /// Modification C: `x|x|` for squares.
    pub squares: Squares,
}

/// Modification A.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Symmetry {
    /// As published: X is even, Y and N are odd in sway, yaw and every sine of an angle, separately
    /// for each side of a pair.
    #[default]
    Parity,
    /// The mirror also exchanges the sides of a pair: they share coefficients, and terms that
    /// differ only by the side remain.
    Mirror,
    /// No selection.
    None,
}

/// Modification B.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrigonometricPowers {
    /// Sines and cosines appear at most once.
    #[default]
    Drop,
    /// They appear to every power.
    Keep,
}

/// Exceptions from modification B.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExceptionFile {
    /// The factor whose square remains, such as `cosdelta_s`.
    pub factor: String,
    /// The axes on which it remains.
    pub axes: Vec<Axis>,
}

/// Modification C.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Squares {
    /// As the text describes: squares of factors that are even in the mirror become `x|x|`, on
    /// every axis.
    #[default]
    AsDescribed,
    /// As Eqs. 14 to 16 are printed: in Y and N the squares of factors that are odd in the mirror
    /// become `x|x|`, which makes terms such as `v|v|r` biases.
    AsPrinted,
    /// Squares remain squares.
    Plain,
}

/// Conditions under which coefficients deviate.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SubmodelsFile {
    /// Conditions of a publication.
    Scheme(Scheme),
    /// Conditions by name; the first one whose comparisons all hold applies.
    #[schemars(with = "BTreeMap<String, SubmodelFile>")]
    Declared(IndexMap<String, SubmodelFile>),
}

impl Default for SubmodelsFile {
    fn default() -> Self {
        Self::Scheme(Scheme::One)
    }
}

/// Published conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// One set of coefficients for everything.
    One,
    /// Algorithm 1, Submodel-2: ahead and astern.
    AheadAstern,
    /// Algorithm 2, Submodel-3: ahead with or without stalled rudders, and astern.
    AheadStalledAstern,
    /// Algorithm 3, Submodel-4: ahead and astern, each with or without stalled rudders.
    AheadAsternStalled,
    /// The quadrant of u and the revolutions of the only propeller.
    Quadrants,
}

/// An effect used with the law.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectUse {
    /// The effect.
    pub effect: String,
    /// Its form.
    pub form: String,
}
