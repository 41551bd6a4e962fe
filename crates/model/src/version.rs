//! A version: a model with everything that it takes to derive it again, as immutable bytes under a hash.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::model::Model;

/// The format of [`VersionDocument`].
pub const FORMAT: &str = "sistership-version/1";

/// What a version holds. Its bytes are [`VersionDocument::canonical`]; the hash is over them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionDocument {
    /// Always [`FORMAT`].
    pub format: String,
    /// The ship, whose name is also that of the line of versions.
    pub ship: String,
    /// How to derive it.
    pub recipe: Recipe,
    /// The model.
    pub model: Model,
    /// What the refinement reported: errors, coefficients, options, manoeuvres. Null for a published model.
    pub report: serde_json::Value,
}

/// How a version is derived. Everything it starts from is named by the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Recipe {
    /// Taken from the ship's own file.
    Published {
        /// The published model's name among the ship's.
        model: String,
        /// The ship's document.
        ship_sha256: String,
        /// The law's file.
        law_sha256: String,
    },
    /// Refined from a source against trials.
    Refinement {
        /// The version refined.
        source: SourceVersion,
        /// The target ship's document.
        ship_sha256: String,
        /// The law's file.
        law_sha256: String,
        /// Where the source is of another law.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        across: Option<AcrossLaws>,
        /// The trials, in the order in which they were given.
        trials: Vec<RecipeTrial>,
        /// Every setting.
        settings: serde_json::Value,
        /// The program that did it.
        code_revision: String,
    },
}

/// Two laws of a refinement whose source is of another law than what is fitted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AcrossLaws {
    /// The name of the law that is fitted.
    pub law: String,
    /// The file of the source's law.
    pub source_law_sha256: String,
}

/// A version that another starts from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceVersion {
    /// Its ship.
    pub ship: String,
    /// Its number.
    pub number: i64,
    /// The hash of its document.
    pub sha256: String,
}

/// A trial of a recipe.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecipeTrial {
    /// Its name.
    pub name: String,
    /// The hash of its samples.
    pub sha256: String,
}

impl VersionDocument {
    /// The bytes that are stored and hashed: JSON with fields in the order of this type and maps in order of their keys.
    ///
    /// # Errors
    /// Where a number is not finite, which no checked model has.
    pub fn canonical(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }
}

/// The SHA-256 of some bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
