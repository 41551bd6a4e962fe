//! Uploads whose files have arrived and that a person looks over before they are kept.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use sistership_pages::upload::Proposed;
use tempfile::TempDir;
use uuid::Uuid;

/// The most that wait at once; the oldest gives way.
const MOST: usize = 16;
/// How long one may wait.
const LONGEST: Duration = Duration::from_secs(3600);

/// The uploads of this process that wait for a person.
#[derive(Debug, Default)]
pub struct Drafts(Mutex<BTreeMap<String, (Instant, Arc<Draft>)>>);

/// One of them.
#[derive(Debug)]
pub struct Draft {
    /// Where its files lie under their names; they go with it.
    pub folder: TempDir,
    /// Name and hash of each.
    pub files: Vec<(String, String)>,
    /// How they are read.
    pub proposed: Mutex<Proposed>,
}

impl Draft {
    /// How its files are read now.
    pub fn proposed(&self) -> Proposed {
        self.proposed.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Reads them in another way from now on.
    pub fn set(&self, proposed: Proposed) {
        *self.proposed.lock().unwrap_or_else(PoisonError::into_inner) = proposed;
    }
}

impl Drafts {
    /// An id for the next.
    pub fn id() -> String {
        Uuid::now_v7().to_string()
    }

    /// Lets one wait.
    pub fn put(&self, id: String, draft: Draft) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|_, (since, _)| since.elapsed() < LONGEST);
        while all.len() >= MOST {
            // Ids rise with time.
            all.pop_first();
        }
        all.insert(id, (Instant::now(), Arc::new(draft)));
    }

    /// One of a ship, as long as it waits.
    pub fn get(&self, ship: &str, id: &str) -> Option<Arc<Draft>> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (since, draft) = all.get(id)?;
        let waits = since.elapsed() < LONGEST && draft.proposed().ship == ship;
        waits.then(|| Arc::clone(draft))
    }

    /// Takes one away.
    pub fn remove(&self, id: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(id);
    }
}
