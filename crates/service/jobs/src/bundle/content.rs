//! Content of a bundle.

use std::collections::BTreeMap;

use bytes::Bytes;
use serde::{Deserialize, Serialize};

/// Content of a bundle without the objects. Ships, laws and versions are referred to by name; the
/// source versions of each version are included.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BundleContent {
    /// The ship that was exported.
    pub ship: String,
    /// Texts of laws by name.
    pub laws: BTreeMap<String, String>,
    /// Libraries of effects.
    pub effects: Vec<String>,
    /// Documents of ships.
    pub ships: Vec<ShipRecord>,
    /// Trials; their samples are objects of the bundle, by hash.
    pub trials: Vec<TrialRecord>,
    /// Versions by ship, each history from its first version on.
    pub lines: BTreeMap<String, Vec<VersionRecord>>,
    /// Versions of the ship by alias.
    pub aliases: BTreeMap<String, i64>,
}

/// A ship with all its revisions, the first one first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShipRecord {
    /// Its name.
    pub name: String,
    /// Title, category and document at each revision.
    pub revisions: Vec<ShipRevision>,
}

/// A ship at a revision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShipRevision {
    /// Name for people.
    pub title: String,
    /// Its kind.
    pub category: String,
    /// The vessel as canonical JSON.
    pub document: String,
}

/// A trial, but for its samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRecord {
    /// The ship.
    pub ship: String,
    /// The SHA-256 of the samples.
    pub sha256: String,
    /// Name given on upload.
    pub name: String,
    /// The manifest, JSON.
    pub manifest: String,
    /// The conventions of the file it came from, JSON.
    pub conventions: String,
    /// The manoeuvre, where it is known.
    pub manoeuvre: Option<String>,
    /// The number of samples.
    pub sample_rows: i64,
    /// Duration, s.
    pub duration_s: f64,
    /// Warnings of the checks, JSON.
    pub warnings: String,
}

/// Version of a ship's model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionRecord {
    /// Ship and number of the version it was made from.
    pub parent: Option<(String, i64)>,
    /// The law of motion.
    pub law: String,
    /// Method of its derivation.
    pub method: String,
    /// The SHA-256 of its document.
    pub sha256: String,
    /// Document of the version, byte for byte.
    pub document: String,
    /// SHA-256 of the weights of its learned correction, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<String>,
    /// Reports on the version, oldest first.
    pub reports: Vec<ReportRecord>,
}

/// A report on a version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReportRecord {
    /// Kind of report.
    pub kind: String,
    /// Its data, JSON.
    pub document: String,
    /// Its page.
    pub html: String,
}

/// A bundle in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Bundle {
    /// Everything but the objects.
    pub content: BundleContent,
    /// Samples of trials and weights of learned corrections as they are stored, by their SHA-256.
    pub objects: BTreeMap<String, Bytes>,
}
