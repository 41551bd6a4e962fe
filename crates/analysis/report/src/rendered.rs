//! Rendered reports, and the errors of rendering.

use serde::Serialize;
use sistership_simulation::PlantError;

/// Version by ship, number and hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct VersionLabel {
    /// Name of the ship.
    pub ship: String,
    /// Number of the version.
    pub number: i64,
    /// Hash of its document, in hexadecimal.
    pub sha256: String,
}

/// Report as a page and as JSON.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderedReport {
    /// Content as JSON.
    pub json: serde_json::Value,
    /// Self-contained HTML page.
    pub html: String,
}

/// Error of rendering a report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A model cannot be simulated.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The page could not be written.
    #[error("the report could not be written: {0}")]
    Page(#[from] askama::Error),
    /// The data could not be written.
    #[error("the report could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}
