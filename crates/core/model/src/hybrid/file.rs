//! The shape of a declaration's YAML file.

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
    /// One line for people.
    pub title: String,
    /// Publications by key, beside that of the hybrid itself.
    #[serde(default)]
    pub sources: BTreeMap<String, Source>,
    /// Highest degree of the polynomials, 1 to 4.
    pub order: u32,
    /// Whether coefficients carry units.
    #[serde(default)]
    pub scaling: Scaling,
    /// What moves the ship, by name.
    #[schemars(with = "BTreeMap<String, ActuatorFile>")]
    pub actuators: IndexMap<String, ActuatorFile>,
    /// Which terms of the expansion stay, and how they are written.
    #[serde(default)]
    pub rules: Rules,
    /// Conditions under which coefficients deviate.
    #[serde(default)]
    pub submodels: SubmodelsFile,
    /// How many times the precision of a deviation's prior is that of a shared coefficient's.
    #[serde(default = "default_shrinkage")]
    pub shrinkage: f64,
    /// Effects that go with the law; they are no part of it, but their parameters are unknowns too.
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

/// Whether coefficients carry units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// Forces in N of velocities in SI, as Miyauchi 2024, Idea 6: coefficients belong to one ship.
    Dimensional,
    /// The bis system: mass, Lpp and g as units, so that coefficients carry over by Froude's law
    /// and rest divides by nothing.
    #[default]
    Bis,
}

/// One actuator, or a pair of them.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActuatorFile {
    /// What it is.
    pub kind: ActuatorKind,
    /// Whether there is one on either side, `NAME_s` and `NAME_p`; a VecTwin always is.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub pair: bool,
    /// How an angle enters the expansion.
    #[serde(default)]
    pub angle: AngleFeature,
    /// Nominal stall angle of a rudder, deg: one, or starboard and port.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stall_deg: Option<StallFile>,
    /// With what its terms are multiplied.
    #[serde(default)]
    pub couples: Coupling,
    /// Axes on which it acts; all of them where absent.
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

/// How an angle enters the expansion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AngleFeature {
    /// By sine and cosine: Miyauchi 2024, Eq. 6.
    #[default]
    SineCosine,
    /// By sine and 1 - cos, so that a rudder amidships adds nothing to a ship at rest.
    SineVersine,
    /// By itself, as Abkowitz.
    Plain,
}

/// A stall angle, or two.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum StallFile {
    /// Of one rudder or of both, deg.
    Both(f64),
    /// Of either, deg.
    Sides {
        /// Of the starboard one.
        starboard: f64,
        /// Of the port one.
        port: f64,
    },
}

/// With what an actuator's terms are multiplied.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// With the ship's motion and every other actuator.
    #[default]
    All,
    /// With the ship's motion only: its flow meets no other actuator.
    Hull,
    /// With nothing.
    None,
}

/// Which terms stay and how they are written: Miyauchi 2024, sec. 2.2.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rules {
    /// Keep the force at rest, the first term of Eq. 7.
    pub constant: bool,
    /// Modification A: selection by port/starboard symmetry.
    pub symmetry: Symmetry,
    /// Keep in Y and N what has no factor that is odd in the mirror, such as `Y_n`: the bias of a
    /// single screw.
    pub zeroth_powers: bool,
    /// Bring `v|v|` back where modification A has taken `v^2`: cross-flow drag.
    pub signed_squares: bool,
    /// Modification B: drop powers of sines and cosines.
    pub trigonometric_powers: TrigonometricPowers,
    /// Squares that modification B leaves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub trigonometric_exceptions: Vec<ExceptionFile>,
    /// Modification C: `x|x|` for squares.
    pub squares: Squares,
}

/// Modification A.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Symmetry {
    /// As published: X is even, Y and N are odd in sway, yaw and every sine of an angle, each side
    /// of a pair by itself.
    #[default]
    Parity,
    /// The mirror also exchanges the sides of a pair: they share coefficients, and what only
    /// differs between them stays.
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

/// Squares that modification B leaves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExceptionFile {
    /// The factor whose square stays, such as `cosdelta_s`.
    pub factor: String,
    /// The axes on which it stays.
    pub axes: Vec<Axis>,
}

/// Modification C.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Squares {
    /// As the text says: squares of what is even in the mirror become `x|x|`, on every axis.
    #[default]
    AsDescribed,
    /// As Eqs. 14 to 16 print: in Y and N it is the squares of what is odd in the mirror that
    /// become `x|x|`, which makes `v|v|r` and its like biases.
    AsPrinted,
    /// Squares stay squares.
    Plain,
}

/// Conditions under which coefficients deviate.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SubmodelsFile {
    /// Those of a publication.
    Scheme(Scheme),
    /// Conditions by name, the first whose comparisons all hold applies.
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
    /// By the quadrant of u and the revolutions of the only propeller.
    Quadrants,
}

/// An effect that goes with the law.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectUse {
    /// The effect.
    pub effect: String,
    /// Its form.
    pub form: String,
}
