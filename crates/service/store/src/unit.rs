//! The transaction of a unit of work. It begins with the first write, so that what comes before it
//! holds nobody up, and reads through the handle see it. Each repository's own transaction becomes
//! a step of it, undone by itself where it fails.

use std::fmt;
use std::sync::Arc;

use tokio::sync::{Mutex, OwnedMutexGuard};

use crate::chain;
use crate::connections::{DatabaseTransaction, Writer};
use crate::entry::Entry;
use crate::error::{Result, StoreError};

/// The transaction that the clones of a handle share.
#[derive(Clone, Default)]
pub(crate) struct Unit(Arc<Mutex<UnitState>>);

#[derive(Default)]
struct UnitState {
    transaction: Option<DatabaseTransaction>,
    /// What its steps enter into the audit, at its end: who has done that waits for nothing more.
    entries: Vec<Entry>,
    /// Whether the last step came to nothing and is still to be taken back.
    undo: bool,
    ended: bool,
}

/// The unit while somebody uses it; a step of it is taken back unless [kept](Self::keep).
pub(crate) struct UnitStep {
    state: OwnedMutexGuard<UnitState>,
    writes: bool,
}

impl fmt::Debug for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Unit").finish_non_exhaustive()
    }
}

impl Unit {
    /// Begins a step, and with the first one the transaction.
    pub(crate) async fn step(&self, writer: &Writer) -> Result<UnitStep> {
        let mut step = self.enter().await?;
        if step.state.transaction.is_none() {
            step.state.transaction = Some(writer.begin().await?);
        }
        step.transaction()?.run("SAVEPOINT step").await?;
        step.writes = true;
        Ok(step)
    }

    /// The transaction to read in, if it has begun.
    pub(crate) async fn open(&self) -> Result<Option<UnitStep>> {
        let step = self.enter().await?;
        Ok(step.state.transaction.is_some().then_some(step))
    }

    async fn enter(&self) -> Result<UnitStep> {
        let mut state = Arc::clone(&self.0).lock_owned().await;
        if state.ended {
            return Err(ended());
        }
        if std::mem::take(&mut state.undo)
            && let Some(mut transaction) = state.transaction.take()
        {
            // Where this fails the whole of it is taken back, with what must not be kept.
            state.ended = true;
            transaction.run("ROLLBACK TO SAVEPOINT step").await?;
            (state.transaction, state.ended) = (Some(transaction), false);
        }
        Ok(UnitStep { state, writes: false })
    }

    /// Ends it, and gives the transaction if it has begun, with all in it but the commit.
    pub(crate) async fn end(&self) -> Result<Option<DatabaseTransaction>> {
        let mut step = self.enter().await?;
        step.state.ended = true;
        let entries = std::mem::take(&mut step.state.entries);
        let Some(mut transaction) = step.state.transaction.take() else { return Ok(None) };
        chain::enter(&mut transaction, entries).await?;
        Ok(Some(transaction))
    }

    /// Ends it with nothing kept.
    pub(crate) async fn undo(&self) {
        if let Ok(mut step) = self.enter().await {
            step.state.ended = true;
            // Whatever cannot be rolled back in words goes with its connection.
            drop(step.state.transaction.take());
        }
    }
}

impl UnitStep {
    pub(crate) fn transaction(&mut self) -> Result<&mut DatabaseTransaction> {
        self.state.transaction.as_mut().ok_or_else(ended)
    }

    /// Keeps the step, with what it enters into the audit, as a part of the whole.
    pub(crate) async fn keep(mut self, entries: Vec<Entry>) -> Result<()> {
        self.transaction()?.run("RELEASE SAVEPOINT step").await?;
        self.state.entries.extend(entries);
        self.writes = false;
        Ok(())
    }
}

impl Drop for UnitStep {
    fn drop(&mut self) {
        self.state.undo |= self.writes;
    }
}

fn ended() -> StoreError {
    StoreError::conflict("unit of work", "", "has ended")
}

/// Where a test can end a unit of work as the end of its process would.
#[cfg(feature = "testing")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// Everything is written and nothing is kept.
    BeforeCommit,
    /// Everything is kept and nobody has been told.
    AfterCommit,
}
