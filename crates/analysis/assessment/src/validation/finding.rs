//! What a check of a contributed ship says.

use serde::Serialize;

/// How much a finding weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The file cannot be taken as it is.
    Refused,
    /// A reviewer should look at it.
    Look,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Finding {
    /// How much it weighs.
    pub severity: Severity,
    /// The field or model that it is about.
    pub about: String,
    /// What was found, and what would be right.
    pub message: String,
}

impl Finding {
    /// The file cannot be taken as it is.
    pub fn refused(about: impl Into<String>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Refused, about: about.into(), message: message.into() }
    }

    /// A reviewer should look at it.
    pub fn look(about: impl Into<String>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Look, about: about.into(), message: message.into() }
    }
}
