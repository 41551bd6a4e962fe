//! Recipe by which a version is derived again. The server stores it in a document with the model.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The format of a version's document.
pub const FORMAT: &str = "sistership-version/1";

/// Recipe of a version. Every input is named by the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
// Only few recipes are in memory at a time.
#[allow(clippy::large_enum_variant)]
pub enum VersionRecipe {
    /// Taken from the ship's own file.
    Published {
        /// The published model's name among the ship's.
        model: String,
        /// The ship's document.
        ship_sha256: String,
        /// The law's file.
        law_sha256: String,
    },
    /// Refined from a source model against trials.
    Refinement {
        /// The source model; absent if the trials alone determined the model.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        source: Option<SourceVersion>,
        /// Name of the law, if there is no source model that has one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        law: Option<String>,
        /// The target ship's document.
        ship_sha256: String,
        /// The law's file.
        law_sha256: String,
        /// The laws, if the source model has another law.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        across: Option<AcrossLaws>,
        /// The ships of the population prior, in order.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        population: Vec<PopulationMember>,
        /// The library of effects with which its calibration was learned.
        effects_sha256: String,
        /// The trials, in the order in which they were given.
        trials: Vec<RecipeTrial>,
        /// All settings.
        settings: serde_json::Value,
        /// Revision of the program that derived it.
        code_revision: String,
    },
}

/// Laws of a refinement whose source model has another law.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AcrossLaws {
    /// The name of the law that is fitted.
    pub law: String,
    /// The file of the source's law.
    pub source_law_sha256: String,
}

/// Ship of a population.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PopulationMember {
    /// Its model.
    pub version: SourceVersion,
    /// The file of the model's law.
    pub law_sha256: String,
}

/// Version from which another one starts.
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

/// Trial of a recipe.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecipeTrial {
    /// Its name.
    pub name: String,
    /// The hash of its samples.
    pub sha256: String,
}

/// Returns the SHA-256 of some bytes, in hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the revision of this program, which every recipe records.
pub fn code_revision() -> &'static str {
    option_env!("SISTERSHIP_REVISION").unwrap_or(env!("CARGO_PKG_VERSION"))
}
