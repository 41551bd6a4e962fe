//! Result of reading a file: a refusal, or the outcome of its checks.

use std::fmt;

use serde::{Serialize, Serializer};
use sistership_model::trial::{Finding, Trial};

use crate::declarations::GeographicPosition;
use crate::derived_channel::DerivedChannel;

/// Refusal of a trial, with every error found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub struct Refusal {
    /// Name of the file as given.
    pub file: String,
    /// Errors, each with row and column where they are known.
    pub findings: Vec<Finding>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} is refused:", self.file)?;
        for finding in &self.findings {
            out.write_str("\n  ")?;
            if let Some(row) = finding.row {
                write!(out, "row {row}: ")?;
            }
            if let Some(column) = &finding.column {
                write!(out, "column `{column}`: ")?;
            }
            out.write_str(&finding.message)?;
        }
        Ok(())
    }
}

/// Trial with data that have no place in it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialReading {
    /// The trial.
    pub trial: Trial,
    /// Calendar time of time zero, such as `2024-05-01T12:00:03Z`, if the file contains it.
    pub start: Option<String>,
    /// Derived channels with their variances.
    pub derived: Vec<DerivedChannel>,
    /// Geographic position of the origin of `x` and `y`: the first fix, or as declared.
    pub origin: Option<GeographicPosition>,
}

/// Outcome of checking one file; serialised as the `check` command prints it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckOutcome {
    /// Name of the file as given.
    pub file: String,
    /// Number of rows of data that can be used.
    pub rows: usize,
    /// Time from the first to the last row, s.
    pub duration_s: f64,
    /// Errors, which refuse the trial.
    #[serde(serialize_with = "with_every_key")]
    pub errors: Vec<Finding>,
    /// Warnings, which do not refuse the trial.
    #[serde(serialize_with = "with_every_key")]
    pub warnings: Vec<Finding>,
}

impl CheckOutcome {
    /// Returns true if the trial is accepted.
    pub fn is_accepted(&self) -> bool {
        self.errors.is_empty()
    }
}

/// Serialises findings with the keys `row` and `column` even if they are empty, as scripts expect
/// them.
fn with_every_key<S: Serializer>(findings: &[Finding], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(findings.iter().map(FindingEntry::from_finding))
}

#[derive(Serialize)]
struct FindingEntry<'a> {
    row: Option<usize>,
    column: Option<&'a str>,
    message: &'a str,
}

impl<'a> FindingEntry<'a> {
    fn from_finding(finding: &'a Finding) -> Self {
        Self { row: finding.row, column: finding.column.as_deref(), message: &finding.message }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn refusals_and_outcomes_read_well() {
        let finding =
            Finding { row: Some(3), column: Some("u".into()), message: "too fast".into() };
        let bare = Finding { row: None, column: None, message: "empty".into() };
        let refusal =
            Refusal { file: "a.csv".into(), findings: vec![finding.clone(), bare.clone()] };
        assert_eq!(
            refusal.to_string(),
            "a.csv is refused:\n  row 3: column `u`: too fast\n  empty"
        );
        let outcome = CheckOutcome {
            file: "a.csv".into(),
            rows: 2,
            duration_s: 0.5,
            errors: vec![bare],
            warnings: vec![finding],
        };
        let text = serde_json::to_string(&outcome).unwrap();
        assert_eq!(
            text,
            r#"{"file":"a.csv","rows":2,"duration_s":0.5,"errors":[{"row":null,"column":null,"message":"empty"}],"warnings":[{"row":3,"column":"u","message":"too fast"}]}"#
        );
        assert!(!outcome.is_accepted());
    }
}
