//! Input of the report of a diagnosis.

use sistership_diagnosis::Diagnosis;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};

use crate::rendered::VersionLabel;

/// Input of the report of a diagnosis.
#[derive(Debug, Clone)]
pub struct DiagnosisInput<'a> {
    /// Result of the diagnosis.
    pub diagnosis: &'a Diagnosis,
    /// Diagnosed model.
    pub model: &'a Model,
    /// Law of the model, without effects.
    pub law: &'a Law,
    /// Trials of the diagnosis.
    pub trials: &'a [&'a Trial],
    /// Diagnosed version, if the model is stored as one.
    pub of: Option<VersionLabel>,
    /// New version with the effects, if it is stored.
    pub made: Option<VersionLabel>,
}
