//! Drafts: uploads whose files have arrived and that a person reviews before they are stored.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use sistership_pages::upload::UploadProposal;
use tempfile::TempDir;
use uuid::Uuid;

/// Maximum number of drafts; the oldest is removed for a new one.
const MOST: usize = 16;
/// Maximum age of a draft.
const LONGEST: Duration = Duration::from_secs(3600);

/// The drafts of this process, by id.
#[derive(Debug, Default)]
pub struct DraftTable(Mutex<BTreeMap<String, (Instant, Arc<UploadDraft>)>>);

/// An upload under review.
#[derive(Debug)]
pub struct UploadDraft {
    /// Folder with its files under their names; it is removed with the draft.
    pub folder: TempDir,
    /// Name and hash of each file.
    pub files: Vec<(String, String)>,
    /// Proposed manifest: how the files are read.
    pub proposed: Mutex<UploadProposal>,
}

impl UploadDraft {
    /// Returns the present proposal.
    pub fn current_proposal(&self) -> UploadProposal {
        self.proposed.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Replaces the proposal.
    pub fn set_proposal(&self, proposed: UploadProposal) {
        *self.proposed.lock().unwrap_or_else(PoisonError::into_inner) = proposed;
    }
}

impl DraftTable {
    /// Creates an id for a new draft.
    pub fn new_id() -> String {
        Uuid::now_v7().to_string()
    }

    /// Adds a draft, and removes expired ones.
    pub fn insert_draft(&self, id: String, draft: UploadDraft) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|_, (since, _)| since.elapsed() < LONGEST);
        while all.len() >= MOST {
            // Ids increase with time, so the first one is the oldest.
            all.pop_first();
        }
        all.insert(id, (Instant::now(), Arc::new(draft)));
    }

    /// Returns a draft of a ship, if it has not expired.
    pub fn get(&self, ship: &str, id: &str) -> Option<Arc<UploadDraft>> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (since, draft) = all.get(id)?;
        // The ship is part of the address: a draft of another ship is not shown.
        let waits = since.elapsed() < LONGEST && draft.current_proposal().ship == ship;
        waits.then(|| Arc::clone(draft))
    }

    /// Removes a draft.
    pub fn remove(&self, id: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(id);
    }
}
