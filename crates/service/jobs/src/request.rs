//! Requests of jobs, as stored in their rows.

use serde::{Deserialize, Serialize};
use sistership_identification::refine::RefinementSettings;
use sistership_learned::BranchSettings;

/// Kind of refinement jobs.
pub const REFINEMENT_JOB_KIND: &str = "refinement";

/// Request of a refinement. Everything except the choice of an `auto` source is resolved on
/// submission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefinementJob {
    /// The ship.
    pub ship: String,
    /// Source model.
    pub source: SourceChoice,
    /// The law to fit; by default the source's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// True if source, law and method are selected automatically, because none of them was named.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub search: bool,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// Every setting.
    pub settings: RefinementSettings,
}

/// Kind of diagnosis jobs.
pub const DIAGNOSIS_JOB_KIND: &str = "diagnosis";

/// Request of a diagnosis; everything is resolved on submission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiagnosisJob {
    /// The ship, whose name is also that of its versions.
    pub ship: String,
    /// The number of the version.
    pub number: i64,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// True if these trials are also diagnosed together with the earlier ones since the version was
    /// fitted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub with_earlier: bool,
    /// Every setting.
    pub settings: sistership_diagnosis::Settings,
}

/// Kind of jobs that train learned corrections.
pub const BRANCH_JOB_KIND: &str = "branch";

/// Request to train a learned correction; everything except an open kind is resolved on submission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BranchJob {
    /// The ship, whose name is also that of its versions.
    pub ship: String,
    /// The number of the version that it corrects.
    pub number: i64,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// Settings.
    pub settings: BranchSettings,
}

/// Source model of a refinement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourceChoice {
    /// The best eligible ship of the zoo.
    Auto,
    /// A version.
    Version {
        /// Its ship.
        ship: String,
        /// Its number.
        number: i64,
    },
}
