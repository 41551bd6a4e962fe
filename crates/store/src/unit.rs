//! A unit of work: whatever is written through one handle of the store, in one transaction, with the outcome of the request
//! that asked for it. The transaction begins with the first write, so that what comes before it holds nobody up, and reads
//! through the handle see it. Each repository's own transaction becomes a step of it, undone by itself where it fails.

use std::fmt;
use std::sync::Arc;

use tokio::sync::{Mutex, OwnedMutexGuard};

use crate::database::{Database, Own};
use crate::error::{Result, StoreError};
use crate::idempotency::{self, Ticket};
use crate::store::Store;

/// The transaction that the clones of a handle share.
#[derive(Clone, Default)]
pub(crate) struct Unit(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    own: Option<Own>,
    /// Whether the last step came to nothing and is still to be taken back.
    undo: bool,
    ended: bool,
}

/// The unit while somebody uses it; a step of it is taken back unless [kept](Self::keep).
pub(crate) struct Step {
    state: OwnedMutexGuard<State>,
    writes: bool,
}

impl fmt::Debug for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Unit").finish_non_exhaustive()
    }
}

impl Unit {
    /// Begins a step, and with the first one the transaction.
    pub(crate) async fn step(&self, database: &Database) -> Result<Step> {
        let mut step = self.enter().await?;
        if step.state.own.is_none() {
            step.state.own = Some(database.begin_own().await?);
        }
        step.own()?.run("SAVEPOINT step").await?;
        step.writes = true;
        Ok(step)
    }

    /// The transaction to read in, if it has begun.
    pub(crate) async fn open(&self) -> Result<Option<Step>> {
        let step = self.enter().await?;
        Ok(step.state.own.is_some().then_some(step))
    }

    async fn enter(&self) -> Result<Step> {
        let mut state = Arc::clone(&self.0).lock_owned().await;
        if state.ended {
            return Err(ended());
        }
        if std::mem::take(&mut state.undo)
            && let Some(mut own) = state.own.take()
        {
            // Where this fails the whole of it is taken back, with what must not be kept.
            state.ended = true;
            own.run("ROLLBACK TO SAVEPOINT step").await?;
            (state.own, state.ended) = (Some(own), false);
        }
        Ok(Step { state, writes: false })
    }

    /// Ends it, and gives the transaction if it has begun.
    async fn end(&self) -> Result<Option<Own>> {
        let mut step = self.enter().await?;
        step.state.ended = true;
        Ok(step.state.own.take())
    }
}

impl Step {
    pub(crate) fn own(&mut self) -> Result<&mut Own> {
        self.state.own.as_mut().ok_or_else(ended)
    }

    pub(crate) async fn keep(mut self) -> Result<()> {
        self.own()?.run("RELEASE SAVEPOINT step").await?;
        self.writes = false;
        Ok(())
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        self.state.undo |= self.writes;
    }
}

fn ended() -> StoreError {
    StoreError::conflict("unit of work", "", "has ended")
}

/// Work of which all is kept or nothing, see [`Store::unit`]. It is undone when this and the handles of it are dropped.
#[derive(Debug)]
pub struct UnitOfWork {
    store: Store,
    unit: Unit,
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

impl Store {
    /// Begins work of which all is kept or nothing.
    pub fn unit(&self) -> UnitOfWork {
        let unit = Unit::default();
        UnitOfWork { store: self.within(unit.clone()), unit }
    }
}

impl UnitOfWork {
    /// The handle through which the work is done: what is written by any other is no part of it.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// Keeps the work, and in the same transaction the answer to the request that asked for it. A conflict, which undoes the
    /// work, where that request has been taken over meanwhile.
    pub async fn keep(self, answer: Option<(&Ticket, i64, &str)>) -> Result<()> {
        if let Some((ticket, status, body)) = answer {
            let mut tx = self.store.begin().await?;
            idempotency::answered(&mut tx, ticket, status, body).await?;
            tx.commit().await?;
        }
        let Some(own) = self.unit.end().await? else { return Ok(()) };
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(Moment::BeforeCommit) {
            drop(own);
            return std::future::pending().await;
        }
        own.commit().await?;
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(Moment::AfterCommit) {
            return std::future::pending().await;
        }
        Ok(())
    }

    /// Takes the work back.
    pub async fn undo(self) {
        // Whatever cannot be rolled back in words goes with its connection.
        drop(self.unit.end().await);
    }
}
