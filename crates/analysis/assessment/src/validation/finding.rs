//! Findings of the checks of a contributed ship.

use serde::Serialize;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The file cannot be accepted as it is.
    Refused,
    /// A reviewer should check it.
    Look,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct ReviewFinding {
    /// Severity.
    pub severity: Severity,
    /// Field or model at fault.
    pub about: String,
    /// Finding, and the correct state.
    pub message: String,
}

impl ReviewFinding {
    /// Creates a finding by which the file cannot be accepted as it is.
    pub fn refused(about: impl Into<String>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Refused, about: about.into(), message: message.into() }
    }

    /// Creates a finding that a reviewer should check.
    pub fn for_review(about: impl Into<String>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Look, about: about.into(), message: message.into() }
    }
}
