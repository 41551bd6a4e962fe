//! A unit of work: whatever is written through one handle of the store, in one transaction, with
//! the outcome of the request that asked for it.

use crate::error::Result;
use crate::idempotency::{self, Ticket};
use crate::store::Store;
#[cfg(feature = "testing")]
use crate::unit::Moment;
use crate::unit::Unit;

/// Work of which all is kept or nothing, see [`Store::unit`]. It is undone when this and the
/// handles of it are dropped.
#[derive(Debug)]
pub struct UnitOfWork {
    store: Store,
    unit: Unit,
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

    /// Keeps the work, and in the same transaction the answer to the request that asked for it. A
    /// conflict, which undoes the work, where that request has been taken over meanwhile.
    pub async fn keep(self, answer: Option<(&Ticket, i64, &str)>) -> Result<()> {
        if let Some((ticket, status, body)) = answer {
            let mut tx = self.store.begin().await?;
            idempotency::answered(&mut tx, ticket, status, body).await?;
            tx.commit().await?;
        }
        let Some(transaction) = self.unit.end().await? else { return Ok(()) };
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(Moment::BeforeCommit) {
            drop(transaction);
            return std::future::pending().await;
        }
        transaction.commit().await?;
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(Moment::AfterCommit) {
            return std::future::pending().await;
        }
        Ok(())
    }

    /// Takes the work back.
    pub async fn undo(self) {
        self.unit.undo().await;
    }
}
