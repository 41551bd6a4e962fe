//! A report in both forms, and why there is none.

use serde::Serialize;
use sistership_simulation::PlantError;

/// A version by name and hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct VersionLabel {
    /// The ship.
    pub ship: String,
    /// Its number.
    pub number: i64,
    /// The hash of its document, in hexadecimal.
    pub sha256: String,
}

/// A report in both forms.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The content as data.
    pub json: serde_json::Value,
    /// A page that stands alone.
    pub html: String,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A model does not simulate.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The page could not be written.
    #[error("the report could not be written: {0}")]
    Page(#[from] askama::Error),
    /// The data could not be written.
    #[error("the report could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}
