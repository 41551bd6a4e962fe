//! Units of work: all writes through one handle of the store, in one transaction, with the answer
//! to the request that caused them.

use crate::error::Result;
use crate::idempotency::{self, RequestTicket};
use crate::store::Store;
#[cfg(feature = "testing")]
use crate::unit::CrashPoint;
use crate::unit::{EndedUnit, UnitTransaction};

/// Work that is committed completely or not at all, see [`Store::unit`]. It is rolled back when
/// this and its handles are dropped.
#[derive(Debug)]
pub struct UnitOfWork {
    store: Store,
    unit: UnitTransaction,
}

impl Store {
    /// Begins a unit of work.
    pub fn begin_unit(&self) -> UnitOfWork {
        let unit = UnitTransaction::default();
        UnitOfWork { store: self.with_unit(unit.clone()), unit }
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
    pub async fn commit(self, answer: Option<(&RequestTicket, i64, &str)>) -> Result<()> {
        if let Some((ticket, status, body)) = answer {
            let mut tx = self.store.begin().await?;
            idempotency::store_answer(&mut tx, ticket, status, body).await?;
            tx.commit().await?;
        }
        let Some(EndedUnit { transaction, queues_jobs }) = self.unit.end_unit().await? else {
            return Ok(());
        };
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(CrashPoint::BeforeCommit) {
            drop(transaction);
            return std::future::pending().await;
        }
        transaction.commit().await?;
        if queues_jobs {
            self.store.database().queue.raise();
        }
        #[cfg(feature = "testing")]
        if self.store.is_to_end_at(CrashPoint::AfterCommit) {
            return std::future::pending().await;
        }
        Ok(())
    }

    /// Rolls the work back.
    pub async fn rollback(self) {
        self.unit.rollback_unit().await;
    }
}
