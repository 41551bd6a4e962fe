//! Units of work: all writes through one handle of the store, in one transaction, with the answer
//! to the request that caused them.

use crate::error::Result;
use crate::idempotency::{self, Ticket};
use crate::store::Store;
#[cfg(feature = "testing")]
use crate::unit::Moment;
use crate::unit::Unit;

/// Work that is committed completely or not at all, see [`Store::unit`]. It is rolled back when
/// this and its handles are dropped.
#[derive(Debug)]
pub struct UnitOfWork {
    store: Store,
    unit: Unit,
}

impl Store {
    /// Begins a unit of work.
    pub fn unit(&self) -> UnitOfWork {
        let unit = Unit::default();
        UnitOfWork { store: self.within(unit.clone()), unit }
    }
}

impl UnitOfWork {
    /// Returns the handle of the unit; writes through other handles are not part of it.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// Commits the work, and in the same transaction the answer (ticket, HTTP status, body) to the
    /// request that caused it.
    ///
    /// # Errors
    /// Returns a conflict, and rolls the work back, if another process has taken over the request.
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

    /// Rolls the work back.
    pub async fn undo(self) {
        self.unit.undo().await;
    }
}
