//! What the report of a diagnosis is made of.

use sistership_diagnosis::Diagnosis;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};

use crate::rendered::VersionLabel;

/// What the report of a diagnosis is made of.
#[derive(Debug, Clone)]
pub struct DiagnosisInput<'a> {
    /// The diagnosis.
    pub diagnosis: &'a Diagnosis,
    /// The model that was diagnosed.
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// The trials.
    pub trials: &'a [&'a Trial],
    /// The version that was diagnosed, where it is one.
    pub of: Option<VersionLabel>,
    /// The version that came of it, where it is kept.
    pub made: Option<VersionLabel>,
}
