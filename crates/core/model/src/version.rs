//! What it takes to derive a version again. The server has the document that holds it with the
//! model.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The format of a version's document.
pub const FORMAT: &str = "sistership-version/1";

/// How a version is derived. Everything it starts from is named by the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
// A handful of them is in memory at a time.
#[allow(clippy::large_enum_variant)]
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
        /// The version refined; none where the trials alone made the model.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        source: Option<SourceVersion>,
        /// The law's name, where there is no source to tell it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        law: Option<String>,
        /// The target ship's document.
        ship_sha256: String,
        /// The law's file.
        law_sha256: String,
        /// Where the source is of another law.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        across: Option<AcrossLaws>,
        /// The ships whose population was the prior, in their order.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        population: Vec<PopulationMember>,
        /// The library of effects that its calibration was learned with; absent in recipes of
        /// releases that had one only.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        effects_sha256: Option<String>,
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

/// A ship of a population.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PopulationMember {
    /// Its model.
    pub version: SourceVersion,
    /// The file of the model's law.
    pub law_sha256: String,
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

/// The SHA-256 of some bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The revision of this program, which every recipe records.
pub fn code_revision() -> &'static str {
    option_env!("SISTERSHIP_REVISION").unwrap_or(env!("CARGO_PKG_VERSION"))
}
