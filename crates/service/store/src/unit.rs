//! The transaction of a unit of work. It begins with the first write, so that the reads before do
//! not block others, and later reads through the handle see it. Each transaction of a repository
//! becomes a step of it, rolled back alone if it fails.

use std::fmt;
use std::sync::Arc;

use tokio::sync::{Mutex, OwnedMutexGuard};

use crate::chain;
use crate::connections::{DatabaseTransaction, DatabaseWriter};
use crate::entry::NewAuditEntry;
use crate::error::{Result, StoreError};

/// The transaction that the clones of a handle share.
#[derive(Clone, Default)]
pub(crate) struct UnitTransaction(Arc<Mutex<UnitState>>);

#[derive(Default)]
struct UnitState {
    transaction: Option<DatabaseTransaction>,
    /// Audit entries of its steps, appended at its end: after that the transaction waits for
    /// nothing more.
    entries: Vec<NewAuditEntry>,
    /// True if one of its steps queues jobs.
    queues_jobs: bool,
    /// True if the last step has failed and is still to be rolled back.
    undo: bool,
    ended: bool,
}

/// The transaction of a unit that has ended, complete except for the commit.
pub(crate) struct EndedUnit {
    pub transaction: DatabaseTransaction,
    /// True if jobs are queued by it.
    pub queues_jobs: bool,
}

/// Exclusive use of the unit; a step that writes is rolled back unless [kept](Self::keep).
pub(crate) struct UnitStep {
    state: OwnedMutexGuard<UnitState>,
    writes: bool,
}

impl fmt::Debug for UnitTransaction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Unit").finish_non_exhaustive()
    }
}

impl UnitTransaction {
    /// Begins a step, and the transaction with the first one.
    pub(crate) async fn begin_step(&self, writer: &DatabaseWriter) -> Result<UnitStep> {
        let mut step = self.lock_state().await?;
        if step.state.transaction.is_none() {
            step.state.transaction = Some(writer.begin().await?);
        }
        step.database_transaction()?.run("SAVEPOINT step").await?;
        step.writes = true;
        Ok(step)
    }

    /// Returns the unit for reads in its transaction, if that has begun.
    pub(crate) async fn open_transaction(&self) -> Result<Option<UnitStep>> {
        let step = self.lock_state().await?;
        Ok(step.state.transaction.is_some().then_some(step))
    }

    async fn lock_state(&self) -> Result<UnitStep> {
        let mut state = Arc::clone(&self.0).lock_owned().await;
        if state.ended {
            return Err(ended_error());
        }
        if std::mem::take(&mut state.undo)
            && let Some(mut transaction) = state.transaction.take()
        {
            // If the rollback fails, the unit ends and its transaction is dropped, as it contains
            // the failed step.
            state.ended = true;
            transaction.run("ROLLBACK TO SAVEPOINT step").await?;
            (state.transaction, state.ended) = (Some(transaction), false);
        }
        Ok(UnitStep { state, writes: false })
    }

    /// Ends the unit and returns its transaction, if it has begun.
    pub(crate) async fn end_unit(&self) -> Result<Option<EndedUnit>> {
        let mut step = self.lock_state().await?;
        step.state.ended = true;
        let entries = std::mem::take(&mut step.state.entries);
        let Some(mut transaction) = step.state.transaction.take() else { return Ok(None) };
        chain::append_entries(&mut transaction, entries).await?;
        Ok(Some(EndedUnit { transaction, queues_jobs: step.state.queues_jobs }))
    }

    /// Ends the unit and rolls it back.
    pub(crate) async fn rollback_unit(&self) {
        if let Ok(mut step) = self.lock_state().await {
            step.state.ended = true;
            // Dropping the transaction rolls it back.
            drop(step.state.transaction.take());
        }
    }
}

impl UnitStep {
    pub(crate) fn database_transaction(&mut self) -> Result<&mut DatabaseTransaction> {
        self.state.transaction.as_mut().ok_or_else(ended_error)
    }

    /// Releases the savepoint of the step and adds its audit entries to the unit.
    pub(crate) async fn commit_step(
        mut self,
        entries: Vec<NewAuditEntry>,
        queues_jobs: bool,
    ) -> Result<()> {
        self.database_transaction()?.run("RELEASE SAVEPOINT step").await?;
        self.state.entries.extend(entries);
        self.state.queues_jobs |= queues_jobs;
        self.writes = false;
        Ok(())
    }
}

impl Drop for UnitStep {
    fn drop(&mut self) {
        // `drop` cannot wait for the database: the next use of the unit rolls the step back.
        self.state.undo |= self.writes;
    }
}

fn ended_error() -> StoreError {
    StoreError::conflict("unit of work", "", "has ended")
}

/// Moment at which a test can stop a unit of work, as the end of its process would.
#[cfg(feature = "testing")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrashPoint {
    /// Everything is written and nothing is committed.
    BeforeCommit,
    /// Everything is committed and nothing is acknowledged.
    AfterCommit,
}
