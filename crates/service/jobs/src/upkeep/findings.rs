//! Findings of a check of an archive.

use serde::Serialize;
use sistership_store::IntegrityFault;

/// Objects that nothing refers to.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct UnreferencedObjects {
    /// Number of objects.
    pub objects: usize,
    /// Total size, bytes.
    pub bytes: u64,
}

/// Numbers of items that were checked.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct CheckCounts {
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
    pub faults: Vec<IntegrityFault>,
    /// Numbers of items that were checked.
    pub checked: CheckCounts,
    /// Objects that no trial and no version refers to. They are no fault: `gc` removes them.
    pub unreferred: UnreferencedObjects,
    /// Uploads that are in progress or were interrupted. They are no fault: `gc` removes old ones.
    pub unfinished: UnreferencedObjects,
}

impl Findings {
    pub(super) fn add_fault(
        &mut self,
        check: &'static str,
        place: String,
        message: impl Into<String>,
    ) {
        self.faults.push(IntegrityFault::new(check, place, message));
    }
}
