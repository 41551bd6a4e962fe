//! The sessions of a server: few at a time, each somebody's own, ended when nobody asks.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::under_way::Session;
use crate::predictions::error::{PredictError, Result};

/// How many sessions there may be, and for how long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SessionLimits {
    /// Of a server.
    pub all: usize,
    /// Of one person or key.
    pub of_one: usize,
    /// Without being asked until it ends.
    pub idle: Duration,
}

impl Default for SessionLimits {
    /// A session with 200 draws of a law with 150 coefficients has about 1 MiB.
    fn default() -> Self {
        Self { all: 128, of_one: 16, idle: Duration::from_secs(600) }
    }
}

/// The sessions of a server.
#[derive(Debug, Default)]
pub struct Sessions {
    limits: SessionLimits,
    table: Mutex<HashMap<String, Entry>>,
}

#[derive(Debug)]
struct Entry {
    owner: String,
    handle: Handle,
    used: Instant,
}

/// A session that is there.
#[derive(Debug, Clone)]
pub struct Handle {
    /// What sails: `model`, `version`, `sha256`, `law`.
    pub about: Value,
    session: Arc<Mutex<Session>>,
}

impl Sessions {
    /// None yet.
    pub fn new(limits: SessionLimits) -> Self {
        Self { limits, ..Self::default() }
    }

    fn table(&self) -> MutexGuard<'_, HashMap<String, Entry>> {
        let mut table = self.table.lock().unwrap_or_else(PoisonError::into_inner);
        let idle = self.limits.idle;
        table.retain(|_, entry| entry.used.elapsed() < idle);
        table
    }

    /// Ends those that nobody has asked for a while.
    pub fn tidy(&self) {
        drop(self.table());
    }

    /// Whether somebody may have one more; asked before the work of making one.
    ///
    /// # Errors
    /// There are too many.
    pub fn room(&self, owner: &str) -> Result<()> {
        self.limits.room(&self.table(), owner)
    }

    /// Keeps a session under an id.
    ///
    /// # Errors
    /// There are too many.
    pub fn open(&self, id: &str, owner: &str, about: Value, session: Session) -> Result<Handle> {
        let mut table = self.table();
        self.limits.room(&table, owner)?;
        let handle = Handle { about, session: Arc::new(Mutex::new(session)) };
        let entry = Entry { owner: owner.to_owned(), handle: handle.clone(), used: Instant::now() };
        table.insert(id.to_owned(), entry);
        Ok(handle)
    }

    /// A session of somebody, who is known to use it now.
    ///
    /// # Errors
    /// They have none of this id.
    pub fn find(&self, id: &str, owner: &str) -> Result<Handle> {
        let mut table = self.table();
        let entry = table.get_mut(id).filter(|entry| entry.owner == owner);
        let entry = entry.ok_or_else(|| PredictError::NoSession(id.to_owned()))?;
        entry.used = Instant::now();
        Ok(entry.handle.clone())
    }

    /// Ends a session of somebody.
    ///
    /// # Errors
    /// They have none of this id.
    pub fn close(&self, id: &str, owner: &str) -> Result<()> {
        self.find(id, owner)?;
        self.table().remove(id);
        Ok(())
    }

    /// What somebody has, by id.
    pub fn of(&self, owner: &str) -> Vec<(String, Value)> {
        let table = self.table();
        let own = table.iter().filter(|(_, entry)| entry.owner == owner);
        let mut own: Vec<_> =
            own.map(|(id, entry)| (id.clone(), entry.handle.about.clone())).collect();
        own.sort_by(|a, b| a.0.cmp(&b.0));
        own
    }
}

impl SessionLimits {
    fn room(&self, table: &HashMap<String, Entry>, owner: &str) -> Result<()> {
        let own = table.values().filter(|entry| entry.owner == owner).count();
        if own >= self.of_one {
            return Err(PredictError::ManySessions { whose: "you have", most: self.of_one });
        }
        match table.len() < self.all {
            true => Ok(()),
            false => Err(PredictError::ManySessions { whose: "this server has", most: self.all }),
        }
    }
}

impl Handle {
    /// Does something with the ship, unless another request has it.
    ///
    /// # Errors
    /// Another request has it, or `work` fails.
    pub fn with<T>(&self, work: impl FnOnce(&mut Session) -> Result<T>) -> Result<T> {
        match self.session.try_lock() {
            Ok(mut session) => work(&mut session),
            Err(TryLockError::Poisoned(poisoned)) => work(&mut poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PredictError::SessionBusy),
        }
    }
}
