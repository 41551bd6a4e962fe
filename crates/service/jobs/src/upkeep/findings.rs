//! What a check of an archive looked at and found.

use serde::Serialize;
use sistership_store::Fault;

/// Objects that nothing refers to.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Unreferred {
    /// How many.
    pub objects: usize,
    /// Their size.
    pub bytes: u64,
}

/// What was looked at.
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
    /// Jobs, by what came of them.
    pub jobs: usize,
    /// Diagnoses, by their trials.
    pub diagnoses: usize,
    /// Objects, by their hash.
    pub objects: usize,
    /// Entries of the audit, each by its hash and that of the one before.
    pub audit: usize,
}

/// What was found.
#[derive(Debug, Default, Clone, PartialEq, Eq, Serialize)]
pub struct Findings {
    /// Whether there are no faults.
    pub clean: bool,
    /// The faults.
    pub faults: Vec<Fault>,
    /// What was looked at.
    pub checked: Checked,
    /// Objects that no trial and no version refers to. They are no fault: `gc` removes them.
    pub unreferred: Unreferred,
    /// Puts that are under way or never ended. They are no fault either: `gc` removes them once
    /// they are old.
    pub unfinished: Unreferred,
}

impl Findings {
    pub(super) fn add(&mut self, check: &'static str, place: String, message: impl Into<String>) {
        self.faults.push(Fault::new(check, place, message));
    }
}
