//! Source of a figure.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A publication or another place that a figure can be traced to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Authors, year, title, journal.
    pub citation: String,
    /// Digital object identifier.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doi: Option<String>,
    /// Way in which it was read, if not from the publication itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}
