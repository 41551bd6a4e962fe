//! What a version holds.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_model::Model;

use crate::recipe::Recipe;

/// What a version holds. Its bytes are [`VersionDocument::canonical`]; the hash is over them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionDocument {
    /// Always [`FORMAT`](sistership_model::version::FORMAT).
    pub format: String,
    /// The ship, whose name is also that of the line of versions.
    pub ship: String,
    /// How to derive it.
    pub recipe: Recipe,
    /// The model.
    pub model: Model,
    /// What was reported as it was made; null for a published model.
    pub report: Value,
}

impl VersionDocument {
    /// The bytes that are stored and hashed: JSON with fields in the order of this type and maps in
    /// order of their keys.
    ///
    /// # Errors
    /// Where a number is not finite, which no checked model has.
    pub fn canonical(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }
}
