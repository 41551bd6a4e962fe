//! Every hash, and every reference between rows, documents and objects.

use serde::Serialize;
use sistership_store::{Fault, Result};

use super::documents;
use super::objects::{self, Unreferred};
use crate::archive::Archive;

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
    /// Objects that no trial refers to. They are no fault: `gc` removes them.
    pub unreferred: Unreferred,
    /// Puts that are under way or never ended. They are no fault either: `gc` removes them once they are old.
    pub unfinished: Unreferred,
}

impl Findings {
    pub(super) fn add(&mut self, check: &'static str, place: String, message: impl Into<String>) {
        self.faults.push(Fault::new(check, place, message));
    }
}

/// Checks all of an archive. It changes nothing, and others may write meanwhile.
///
/// # Errors
/// The database or the object store does not answer; what they hold is told as faults.
pub async fn fsck(archive: &Archive) -> Result<Findings> {
    let mut findings = Findings { faults: archive.store.row_faults().await?, ..Findings::default() };
    documents::laws(archive, &mut findings).await?;
    documents::effects(archive, &mut findings).await?;
    documents::versions(archive, &mut findings).await?;
    documents::jobs(archive, &mut findings).await?;
    documents::diagnoses(archive, &mut findings).await?;
    objects::check(archive, &mut findings).await?;
    findings.clean = findings.faults.is_empty();
    Ok(findings)
}
