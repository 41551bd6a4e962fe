//! Findings of a check of an archive.

use serde::Serialize;
use sistership_store::Fault;

/// Objects that nothing refers to.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Unreferred {
    /// Number of objects.
    pub objects: usize,
    /// Total size, bytes.
    pub bytes: u64,
}

/// Numbers of items that were checked.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Checked {
    /// Laws, by their hash.
    pub laws: usize,
    /// Libraries of effects, by their hash.
    pub effects: usize,
    /// Versions, by their hash and what their recipes name.
    pub versions: usize,
    /// Trials, by their objects.
    pub trials: usize,
    /// Jobs, by their results.
    pub jobs: usize,
    /// Diagnoses, by their trials.
    pub diagnoses: usize,
    /// Objects, by their hash.
    pub objects: usize,
    /// Entries of the audit, each by its hash and that of the one before.
    pub audit: usize,
}

/// Findings of a check.
#[derive(Debug, Default, Clone, PartialEq, Eq, Serialize)]
pub struct Findings {
    /// True if there are no faults.
    pub clean: bool,
    /// The faults.
    pub faults: Vec<Fault>,
    /// Numbers of items that were checked.
    pub checked: Checked,
    /// Objects that no trial and no version refers to. They are no fault: `gc` removes them.
    pub unreferred: Unreferred,
    /// Uploads that are in progress or were interrupted. They are no fault: `gc` removes old ones.
    pub unfinished: Unreferred,
}

impl Findings {
    pub(super) fn add(&mut self, check: &'static str, place: String, message: impl Into<String>) {
        self.faults.push(Fault::new(check, place, message));
    }
}
