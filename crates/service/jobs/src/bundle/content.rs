//! What a bundle holds.

use std::collections::BTreeMap;

use bytes::Bytes;
use serde::{Deserialize, Serialize};

/// Everything but the objects. Ships, laws and versions are named; what a version starts from is
/// among them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Content {
    /// The ship that was asked for.
    pub ship: String,
    /// Texts of laws by name.
    pub laws: BTreeMap<String, String>,
    /// Libraries of effects.
    pub effects: Vec<String>,
    /// Documents of ships.
    pub ships: Vec<ShipRecord>,
    /// Trials; their samples stand beside, by hash.
    pub trials: Vec<TrialRecord>,
    /// Versions by ship, each line from its first on.
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
    pub revisions: Vec<Revision>,
}

/// A ship at a revision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Revision {
    /// What people call it.
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
    /// What the uploader called it.
    pub name: String,
    /// The manifest, JSON.
    pub manifest: String,
    /// The conventions of the file it came from, JSON.
    pub conventions: String,
    /// The manoeuvre, where it is known.
    pub manoeuvre: Option<String>,
    /// The number of samples.
    pub sample_rows: i64,
    /// How long it lasts, s.
    pub duration_s: f64,
    /// What the checks had to say, JSON.
    pub warnings: String,
}

/// A version of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionRecord {
    /// Ship and number of the version it was made from.
    pub parent: Option<(String, i64)>,
    /// The law of motion.
    pub law: String,
    /// How it was made.
    pub method: String,
    /// The SHA-256 of its document.
    pub sha256: String,
    /// The whole record of it, byte for byte.
    pub document: String,
    /// The SHA-256 of the weights of its learned branch, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<String>,
    /// Reports on it, the first one first.
    pub reports: Vec<ReportRecord>,
}

/// A report on a version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReportRecord {
    /// What it reports.
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
    pub content: Content,
    /// Samples of trials and weights of learned branches as they are stored, by their SHA-256.
    pub objects: BTreeMap<String, Bytes>,
}
