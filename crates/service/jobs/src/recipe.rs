//! Recipes of versions: those of [`sistership_model::version`], of a diagnosis, of a learned
//! correction, of a member of a family, and of a model that was made elsewhere.

use std::collections::BTreeSet;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;
use sistership_fleet::bulk::BulkSettings;
use sistership_learned::CorrectionTraining;
use sistership_model::version::{self, PopulationMember, RecipeTrial, SourceVersion};

use crate::input::{DerivationInput, InputKind};

/// Derivation of a version.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum DerivationRecipe {
    /// Addition of the effects that a diagnosis finds.
    Diagnosis(DiagnosisRecipe),
    /// Refinement of a member of a family, from statistics.
    Family(FamilyRecipe),
    /// Training of a learned correction of a version.
    Training(TrainingRecipe),
    /// Registration of a model that was made elsewhere.
    Registered(RegisteredRecipe),
    /// Publication by a ship's own document, or refinement.
    Plain(version::VersionRecipe),
}

/// Derivation of a diagnosis. Every input is named by the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiagnosisRecipe {
    /// Always `diagnosis`.
    pub kind: DiagnosisKind,
    /// The version that was diagnosed.
    pub diagnosed: SourceVersion,
    /// SHA-256 of the law's file.
    pub law_sha256: String,
    /// The trials, in the order in which they were given.
    pub trials: Vec<RecipeTrial>,
    /// SHA-256 of the library of effects.
    pub effects_sha256: String,
    /// Every setting.
    pub settings: Value,
    /// Revision of the program.
    pub code_revision: String,
}

/// Derivation of a version with a learned correction. Every input is named by the SHA-256 of its
/// bytes; its document names the resulting weights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainingRecipe {
    /// Always `branch`.
    pub kind: TrainingKind,
    /// The version that the correction belongs to.
    pub foundation: SourceVersion,
    /// SHA-256 of the law's file.
    pub law_sha256: String,
    /// The trials, in the order in which they were given.
    pub trials: Vec<RecipeTrial>,
    /// SHA-256 of the library of effects.
    pub effects_sha256: String,
    /// Every setting, the seed among them.
    pub settings: CorrectionTraining,
    /// Revision of the program.
    pub code_revision: String,
}

/// Value of `kind` of a training recipe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TrainingKind {
    /// The only one.
    Branch,
}

/// Origin of a model that was made elsewhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegisteredRecipe {
    /// Always `registered`.
    pub kind: RegisteredKind,
    /// SHA-256 of the law's file.
    pub law_sha256: String,
    /// Author and method of the model, as stated on registration.
    pub origin: String,
}

/// The word `registered`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RegisteredKind {
    /// The only one.
    #[default]
    Registered,
}

/// The word `diagnosis`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DiagnosisKind {
    /// The only one.
    Diagnosis,
}

/// Derivation of a member's model from statistics. Every input is named by the SHA-256 of its
/// bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyRecipe {
    /// Always `family`.
    pub kind: FamilyKind,
    /// The version that it started from: its own, or the foundation.
    pub start: SourceVersion,
    /// SHA-256 of the ship's document, if the foundation was transferred to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ship_sha256: Option<String>,
    /// The version that the family is founded on.
    pub foundation: SourceVersion,
    /// The family's prior; by default the coefficients of the foundation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<PriorName>,
    /// SHA-256 of the law's file.
    pub law_sha256: String,
    /// The trials, in the order in which they were used.
    pub trials: Vec<RecipeTrial>,
    /// Every setting.
    pub settings: BulkSettings,
    /// Revision of the program.
    pub code_revision: String,
}

/// The word `family`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FamilyKind {
    /// The only one.
    Family,
}

/// Reference to the prior of a family.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PriorName {
    /// The family.
    pub family: String,
    /// Its revision.
    pub revision: i64,
    /// The hash of its document.
    pub sha256: String,
}

/// Reads a recipe by its kind, so that an error names the field of that kind.
impl<'de> Deserialize<'de> for DerivationRecipe {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let recipe = Value::deserialize(deserializer)?;
        let read = match recipe.get("kind").and_then(Value::as_str) {
            Some("diagnosis") => serde_json::from_value(recipe).map(Self::Diagnosis),
            Some("family") => serde_json::from_value(recipe).map(Self::Family),
            Some("branch") => serde_json::from_value(recipe).map(Self::Training),
            Some("registered") => serde_json::from_value(recipe).map(Self::Registered),
            _ => serde_json::from_value(recipe).map(Self::Plain),
        };
        read.map_err(|error| D::Error::custom(format!("recipe: {error}")))
    }
}

impl DerivationRecipe {
    /// Returns the hash of the law's file.
    pub fn law_sha256(&self) -> &str {
        match self {
            Self::Diagnosis(DiagnosisRecipe { law_sha256, .. })
            | Self::Family(FamilyRecipe { law_sha256, .. })
            | Self::Training(TrainingRecipe { law_sha256, .. })
            | Self::Registered(RegisteredRecipe { law_sha256, .. })
            | Self::Plain(
                version::VersionRecipe::Published { law_sha256, .. }
                | version::VersionRecipe::Refinement { law_sha256, .. },
            ) => law_sha256,
        }
    }

    /// Returns the revision of the program; `None` for a published or registered model.
    pub fn code_revision(&self) -> Option<&str> {
        match self {
            Self::Diagnosis(DiagnosisRecipe { code_revision, .. })
            | Self::Family(FamilyRecipe { code_revision, .. })
            | Self::Training(TrainingRecipe { code_revision, .. })
            | Self::Plain(version::VersionRecipe::Refinement { code_revision, .. }) => {
                Some(code_revision)
            }
            Self::Plain(version::VersionRecipe::Published { .. }) | Self::Registered(_) => None,
        }
    }

    /// Returns the trials that it names.
    pub fn trials(&self) -> &[RecipeTrial] {
        match self {
            Self::Diagnosis(DiagnosisRecipe { trials, .. })
            | Self::Family(FamilyRecipe { trials, .. })
            | Self::Training(TrainingRecipe { trials, .. })
            | Self::Plain(version::VersionRecipe::Refinement { trials, .. }) => trials,
            Self::Plain(version::VersionRecipe::Published { .. }) | Self::Registered(_) => &[],
        }
    }

    /// Returns the hash of the ship's document, if it names one.
    pub fn ship_sha256(&self) -> Option<&str> {
        match self {
            Self::Plain(
                version::VersionRecipe::Published { ship_sha256, .. }
                | version::VersionRecipe::Refinement { ship_sha256, .. },
            ) => Some(ship_sha256),
            Self::Family(recipe) => recipe.ship_sha256.as_deref(),
            Self::Diagnosis(_) | Self::Training(_) | Self::Registered(_) => None,
        }
    }

    /// Returns the version that it starts from; `None` for a published or registered model.
    pub fn source_version(&self) -> Option<&SourceVersion> {
        match self {
            Self::Plain(version::VersionRecipe::Refinement { source, .. }) => source.as_ref(),
            Self::Plain(version::VersionRecipe::Published { .. }) | Self::Registered(_) => None,
            Self::Family(recipe) => Some(&recipe.start),
            Self::Training(recipe) => Some(&recipe.foundation),
            Self::Diagnosis(_) => self.diagnosed_version(),
        }
    }

    /// Returns the hash of the library of effects, if it names one.
    pub fn effects_sha256(&self) -> Option<&str> {
        match self {
            Self::Diagnosis(recipe) => Some(&recipe.effects_sha256),
            Self::Training(recipe) => Some(&recipe.effects_sha256),
            Self::Plain(version::VersionRecipe::Refinement { effects_sha256, .. }) => {
                Some(effects_sha256)
            }
            Self::Family(_)
            | Self::Plain(version::VersionRecipe::Published { .. })
            | Self::Registered(_) => None,
        }
    }

    /// Returns the prior of a family, if that was the prior of the coefficients.
    pub fn family_prior(&self) -> Option<&PriorName> {
        match self {
            Self::Family(recipe) => recipe.prior.as_ref(),
            _ => None,
        }
    }

    /// Returns every version that it names.
    pub fn source_versions(&self) -> Vec<&SourceVersion> {
        let foundation = match self {
            Self::Family(recipe) => Some(&recipe.foundation),
            _ => None,
        };
        let population = self.population_members().iter().map(|member| &member.version);
        self.source_version().into_iter().chain(foundation).chain(population).collect()
    }

    /// Returns the ships of its population, if that was the prior.
    pub fn population_members(&self) -> &[PopulationMember] {
        match self {
            Self::Plain(version::VersionRecipe::Refinement { population, .. }) => population,
            _ => &[],
        }
    }

    /// Returns all inputs of the derivation.
    pub fn all_inputs(&self) -> BTreeSet<DerivationInput> {
        let mut inputs = BTreeSet::from([InputKind::Law.with_hash(self.law_sha256())]);
        if let Self::Plain(version::VersionRecipe::Refinement { across: Some(across), .. }) = self {
            // Across laws the source model is evaluated with its own law.
            inputs.insert(InputKind::Law.with_hash(&across.source_law_sha256));
        }
        let laws = self
            .population_members()
            .iter()
            .map(|member| InputKind::Law.with_hash(&member.law_sha256));
        inputs.extend(laws);
        inputs.extend(self.ship_sha256().map(|hash| InputKind::Ship.with_hash(hash)));
        inputs.extend(
            self.source_versions()
                .into_iter()
                .map(|version| InputKind::Version.with_hash(&version.sha256)),
        );
        // Weights of learned corrections are no inputs of their own: a version's document names
        // them.
        inputs
            .extend(self.trials().iter().map(|trial| InputKind::Samples.with_hash(&trial.sha256)));
        inputs.extend(self.effects_sha256().map(|hash| InputKind::Effects.with_hash(hash)));
        inputs.extend(self.family_prior().map(|prior| InputKind::Prior.with_hash(&prior.sha256)));
        inputs
    }

    /// Returns the version that was diagnosed.
    pub fn diagnosed_version(&self) -> Option<&SourceVersion> {
        match self {
            Self::Diagnosis(recipe) => Some(&recipe.diagnosed),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn recipes_are_told_by_their_kind_and_keep_their_bytes() {
        let published =
            json!({ "kind": "published", "model": "own", "ship_sha256": "a", "law_sha256": "b" });
        let diagnosed = json!({ "kind": "diagnosis",
            "diagnosed": { "ship": "kcs", "number": 2, "sha256": "c" },
            "law_sha256": "b", "trials": [{ "name": "t.csv", "sha256": "d" }],
            "effects_sha256": "e",
            "settings": { "slack": 0.02 }, "code_revision": "1" });
        let registered =
            json!({ "kind": "registered", "law_sha256": "b", "origin": "a towing tank" });
        let trained = json!({ "kind": "branch",
            "foundation": { "ship": "kcs", "number": 2, "sha256": "c" },
            "law_sha256": "b", "trials": [{ "name": "t.csv", "sha256": "d" }],
            "effects_sha256": "e",
            "settings": { "mode": "parallel", "inputs": [["N", ["r", "delta"]]], "learner":
                { "kind": "kernel_ridge", "centres": 9, "length": 3.0, "ridge": 0.5 },
                "seed": 1, "window_s": 2.0, "hop_s": 0.5, "fade": 1.0 }, "code_revision": "1" });
        let all = [(published, None), (registered, None), (diagnosed, Some(2)), (trained, None)];
        for (value, kind) in all {
            let recipe: DerivationRecipe = serde_json::from_value(value.clone()).unwrap();
            assert_eq!(recipe.diagnosed_version().map(|source| source.number), kind);
            assert_eq!(serde_json::to_value(&recipe).unwrap(), value);
            assert_eq!(recipe.law_sha256(), "b");
        }
    }

    #[test]
    fn what_a_recipe_may_not_have_or_lacks_is_named() {
        let refused = |recipe: Value| {
            serde_json::from_value::<DerivationRecipe>(recipe).unwrap_err().to_string()
        };
        let registered = json!({ "kind": "registered", "law_sha256": "b", "origin": "x", "by": 1 });
        assert!(refused(registered).contains("unknown field `by`"));
        let lacking = refused(json!({ "kind": "refinement", "ship_sha256": "a", "law_sha256": "b",
            "trials": [], "settings": {}, "code_revision": "1" }));
        assert!(lacking.contains("missing field `effects_sha256`"), "{lacking}");
        let other = refused(json!({ "kind": "another" }));
        assert!(other.contains("unknown variant `another`"), "{other}");
    }
}
