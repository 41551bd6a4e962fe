//! Sessions of a server: limited in number, each owned by one person or key, ended when idle.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::simulation::PredictionSession;
use crate::predictions::error::{PredictionError, Result};

/// Limits of sessions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SessionLimits {
    /// Number of sessions of a server.
    pub all: usize,
    /// Number of sessions of one person or key.
    pub of_one: usize,
    /// Idle time after which a session ends.
    pub idle: Duration,
}

impl Default for SessionLimits {
    /// A session with 200 draws of a law with 150 coefficients takes about 1 MiB.
    fn default() -> Self {
        Self { all: 128, of_one: 16, idle: Duration::from_secs(600) }
    }
}

/// The sessions of a server.
#[derive(Debug, Default)]
pub struct SessionTable {
    limits: SessionLimits,
    table: Mutex<HashMap<String, SessionEntry>>,
}

#[derive(Debug)]
struct SessionEntry {
    owner: String,
    handle: SessionHandle,
    used: Instant,
}

/// Handle of an open session.
#[derive(Debug, Clone)]
pub struct SessionHandle {
    /// Description of the model: `model`, `version`, `sha256`, `law`.
    pub about: Value,
    session: Arc<Mutex<PredictionSession>>,
}

impl SessionTable {
    /// Creates an empty table.
    pub fn new(limits: SessionLimits) -> Self {
        Self { limits, ..Self::default() }
    }

    fn lock_table(&self) -> MutexGuard<'_, HashMap<String, SessionEntry>> {
        let mut table = self.table.lock().unwrap_or_else(PoisonError::into_inner);
        let idle = self.limits.idle;
        // Idle sessions are removed at every access, so that they count against no limit.
        table.retain(|_, entry| entry.used.elapsed() < idle);
        table
    }

    /// Ends idle sessions.
    pub fn remove_idle(&self) {
        drop(self.lock_table());
    }

    /// Checks that an owner may open another session, before the work of creating one.
    ///
    /// # Errors
    /// Returns an error if the limit of the owner or of the server is reached.
    pub fn check_room(&self, owner: &str) -> Result<()> {
        self.limits.check_limits(&self.lock_table(), owner)
    }

    /// Adds a session under an id.
    ///
    /// # Errors
    /// Returns an error if the limit of the owner or of the server is reached.
    pub fn open(
        &self,
        id: &str,
        owner: &str,
        about: Value,
        session: PredictionSession,
    ) -> Result<SessionHandle> {
        let mut table = self.lock_table();
        // Checked again under the lock: other sessions may have been opened since the first check.
        self.limits.check_limits(&table, owner)?;
        let handle = SessionHandle { about, session: Arc::new(Mutex::new(session)) };
        let entry =
            SessionEntry { owner: owner.to_owned(), handle: handle.clone(), used: Instant::now() };
        table.insert(id.to_owned(), entry);
        Ok(handle)
    }

    /// Returns a session of an owner, and marks it as used.
    ///
    /// # Errors
    /// Returns an error if the owner has no session with this id.
    pub fn find_session(&self, id: &str, owner: &str) -> Result<SessionHandle> {
        let mut table = self.lock_table();
        let entry = table.get_mut(id).filter(|entry| entry.owner == owner);
        let entry = entry.ok_or_else(|| PredictionError::NoSession(id.to_owned()))?;
        entry.used = Instant::now();
        Ok(entry.handle.clone())
    }

    /// Ends a session of an owner.
    ///
    /// # Errors
    /// Returns an error if the owner has no session with this id.
    pub fn close(&self, id: &str, owner: &str) -> Result<()> {
        self.find_session(id, owner)?;
        self.lock_table().remove(id);
        Ok(())
    }

    /// Lists the sessions of an owner by id, with their descriptions.
    pub fn list_sessions(&self, owner: &str) -> Vec<(String, Value)> {
        let table = self.lock_table();
        let own = table.iter().filter(|(_, entry)| entry.owner == owner);
        let mut own: Vec<_> =
            own.map(|(id, entry)| (id.clone(), entry.handle.about.clone())).collect();
        own.sort_by(|a, b| a.0.cmp(&b.0));
        own
    }
}

impl SessionLimits {
    fn check_limits(&self, table: &HashMap<String, SessionEntry>, owner: &str) -> Result<()> {
        let own = table.values().filter(|entry| entry.owner == owner).count();
        if own >= self.of_one {
            return Err(PredictionError::ManySessions { whose: "you have", most: self.of_one });
        }
        match table.len() < self.all {
            true => Ok(()),
            false => {
                Err(PredictionError::ManySessions { whose: "this server has", most: self.all })
            }
        }
    }
}

impl SessionHandle {
    /// Runs `work` on the session, unless another request uses it.
    ///
    /// # Errors
    /// Returns an error if another request uses it, or the error of `work`.
    pub fn with_session<T>(
        &self,
        work: impl FnOnce(&mut PredictionSession) -> Result<T>,
    ) -> Result<T> {
        match self.session.try_lock() {
            Ok(mut session) => work(&mut session),
            // A panic in an earlier request does not end the session.
            Err(TryLockError::Poisoned(poisoned)) => work(&mut poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PredictionError::SessionBusy),
        }
    }
}
