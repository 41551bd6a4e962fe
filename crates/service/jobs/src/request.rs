//! What a job is asked to do, as its row keeps it.

use serde::{Deserialize, Serialize};
use sistership_identification::refine::Settings;
use sistership_learned::BranchSettings;

/// The kind of refinement jobs.
pub const REFINEMENT: &str = "refinement";

/// A refinement to be done. Everything but the choice of an `auto` source is settled when it is
/// asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefinementJob {
    /// The ship.
    pub ship: String,
    /// Where to start.
    pub source: SourceChoice,
    /// The law to fit; the source's where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// Whether source, law and method are searched, since none of them was named.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub search: bool,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// Every setting.
    pub settings: Settings,
    /// The hash of the request's idempotency key, as earlier programs wrote it; now the key is kept
    /// with the job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key_sha256: Option<String>,
}

/// The kind of diagnosis jobs.
pub const DIAGNOSIS: &str = "diagnosis";

/// A diagnosis to be done; everything is settled when it is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiagnosisJob {
    /// The ship, whose name is that of the line of versions.
    pub ship: String,
    /// The number of the version.
    pub number: i64,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// Whether these trials together with those before them since the version was fitted are
    /// diagnosed, too.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub with_earlier: bool,
    /// Every setting.
    pub settings: sistership_diagnosis::Settings,
    /// The hash of the request's idempotency key, as earlier programs wrote it; now the key is kept
    /// with the job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key_sha256: Option<String>,
}

/// The kind of jobs that train learned branches.
pub const BRANCH: &str = "branch";

/// A branch to be trained; everything but an open kind is settled when it is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BranchJob {
    /// The ship, whose name is that of the line of versions.
    pub ship: String,
    /// The number of the version that is its foundation.
    pub number: i64,
    /// The trials' ids.
    pub trials: Vec<String>,
    /// What is asked.
    pub settings: BranchSettings,
}

/// Where a refinement starts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourceChoice {
    /// At the best eligible ship of the zoo.
    Auto,
    /// At a version.
    Version {
        /// Its ship.
        ship: String,
        /// Its number.
        number: i64,
    },
}
