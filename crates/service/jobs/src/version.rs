//! Documents of versions.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_model::Model;

use crate::recipe::DerivationRecipe;

/// Document of a version. Its bytes are those of its canonical JSON; the hash is over them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionDocument {
    /// Always [`FORMAT`](sistership_model::version::FORMAT).
    pub format: String,
    /// The ship, whose name is also that of its versions.
    pub ship: String,
    /// The recipe of its derivation.
    pub recipe: DerivationRecipe,
    /// The model.
    pub model: Model,
    /// Report of its derivation; null for a published model.
    pub report: Value,
}

impl VersionDocument {
    /// Returns the bytes that are stored and hashed: JSON with fields in the order of this type and
    /// maps in the order of their keys.
    ///
    /// # Errors
    /// Returns an error if a number is not finite, which a checked model rules out.
    pub fn to_canonical_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }
}
