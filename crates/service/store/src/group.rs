//! Group commit: SQLite has one writer, and each durable commit waits for the disk. Here writers
//! take turns within one transaction, each with a savepoint, and all of them wait for its single
//! commit. No writer gets an acknowledgement before that commit has returned.
//!
//! The turns are those of a fair lock. After its write, a writer queues for the lock once more,
//! behind those who wait to write; the first of these second turns commits for all. A single writer
//! commits at once.

use std::io;
use std::sync::{Arc, OnceLock};

use sqlx::pool::PoolConnection;
use sqlx::{Sqlite, SqliteConnection, SqlitePool};
use tokio::runtime::Handle;
use tokio::sync::{Mutex, OwnedMutexGuard};

use crate::error::is_full;

/// Outcome of a shared transaction, set once; the reason if it failed.
type CommitOutcome = Arc<OnceLock<Result<(), CommitFailure>>>;

/// Reason for the failure of a transaction, cloned for each of its writers.
#[derive(Debug, Clone)]
struct CommitFailure {
    text: String,
    /// True if there was no space for it.
    full: bool,
}

/// The writers of one SQLite database in this process.
#[derive(Debug, Clone)]
pub(crate) struct WriterGroup {
    pool: SqlitePool,
    shared: Arc<Mutex<Option<SharedTransaction>>>,
}

/// The transaction in progress.
#[derive(Debug)]
struct SharedTransaction {
    connection: PoolConnection<Sqlite>,
    outcome: CommitOutcome,
    /// True if at least one writer waits for the commit.
    awaited: bool,
}

/// One writer's part of the transaction, during its turn; rolled back unless
/// [committed](Self::commit).
pub(crate) struct TransactionPart {
    turn: Option<WriterTurn>,
    /// Runtime in which the part began, and in which it is rolled back: the caller may drop it
    /// outside of any.
    runtime: Handle,
}

struct WriterTurn {
    lock: OwnedMutexGuard<Option<SharedTransaction>>,
    shared: SharedTransaction,
}

impl WriterGroup {
    /// Creates the group on a pool of one connection.
    pub(crate) fn new(pool: SqlitePool) -> Self {
        Self { pool, shared: Arc::default() }
    }

    /// Returns the pool of that connection.
    pub(crate) fn pool(&self) -> &SqlitePool {
        &self.pool
    }

    /// Waits for the turn to write. No other writer is active until the part ends, in this process
    /// and in others.
    pub(crate) async fn begin(&self) -> sqlx::Result<TransactionPart> {
        let Self { pool, shared } = self.clone();
        run_uninterrupted(async move {
            // The guard is owned and moves with the turn; the transaction is out of its slot while
            // the turn lasts.
            let mut lock = shared.lock_owned().await;
            let mut shared = match lock.take() {
                Some(shared) => shared,
                None => SharedTransaction::begin(&pool).await?,
            };
            match shared.run("SAVEPOINT part").await {
                Ok(()) => {
                    let turn = Some(WriterTurn { lock, shared });
                    Ok(TransactionPart { turn, runtime: Handle::current() })
                }
                Err(error) => Err(shared.fail_transaction(error)),
            }
        })
        .await
    }
}

impl TransactionPart {
    /// Returns the connection of the transaction.
    pub(crate) fn connection(&mut self) -> sqlx::Result<&mut SqliteConnection> {
        let turn = self.turn.as_mut().ok_or_else(|| not_kept("it has ended"))?;
        Ok(&mut turn.shared.connection)
    }

    /// Commits the part, together with the parts of other writers.
    pub(crate) async fn commit(mut self) -> sqlx::Result<()> {
        let turn = self.turn.take().ok_or_else(|| not_kept("it has ended"))?;
        run_uninterrupted(turn.commit()).await
    }
}

impl Drop for TransactionPart {
    fn drop(&mut self) {
        if let Some(turn) = self.turn.take() {
            // A runtime that has ended drops the task at once; the pool then closes the connection,
            // for which it needs the context of a runtime, too.
            let _context = self.runtime.enter();
            self.runtime.spawn(turn.rollback_part());
        }
    }
}

impl WriterTurn {
    async fn commit(mut self) -> sqlx::Result<()> {
        if let Err(error) = self.shared.run("RELEASE part").await {
            return Err(self.shared.fail_transaction(error));
        }
        self.shared.awaited = true;
        let outcome = Arc::clone(&self.shared.outcome);
        // From here on others may write in the same transaction; the second turn comes after all
        // who queued before it.
        let queue = self.hand_over();
        let mut lock = queue.lock_owned().await;
        // Without an outcome, the transaction in the slot is still the one that this part belongs
        // to.
        if outcome.get().is_none()
            && let Some(shared) = lock.take()
        {
            shared.commit_shared().await;
        }
        drop(lock);
        match outcome.get() {
            Some(Ok(())) => Ok(()),
            Some(Err(reason)) => Err(reason.to_error()),
            None => Err(not_kept("it was rolled back")),
        }
    }

    /// Rolls back this part; the parts of others stay, and they commit them in their second turns.
    async fn rollback_part(mut self) {
        let undone = match self.shared.run("ROLLBACK TO part").await {
            // Others wait for the commit of this transaction; only the own savepoint is undone.
            Ok(()) if self.shared.awaited => self.shared.run("RELEASE part").await,
            Ok(()) => self.shared.run("ROLLBACK").await,
            Err(error) => Err(error),
        };
        match undone {
            Err(error) => drop(self.shared.fail_transaction(error)),
            Ok(()) if self.shared.awaited => drop(self.hand_over()),
            Ok(()) => {}
        }
    }

    /// Leaves the transaction to the next in the queue.
    fn hand_over(self) -> Arc<Mutex<Option<SharedTransaction>>> {
        let Self { mut lock, shared } = self;
        *lock = Some(shared);
        Arc::clone(OwnedMutexGuard::mutex(&lock))
    }
}

impl SharedTransaction {
    async fn begin(pool: &SqlitePool) -> sqlx::Result<Self> {
        let mut begun = Self {
            connection: pool.acquire().await?,
            outcome: CommitOutcome::default(),
            awaited: false,
        };
        match begun.run("BEGIN IMMEDIATE").await {
            Ok(()) => Ok(begun),
            Err(error) => Err(begun.fail_transaction(error)),
        }
    }

    async fn run(&mut self, sql: &'static str) -> sqlx::Result<()> {
        sqlx::query(sql).execute(&mut *self.connection).await.map(drop)
    }

    async fn commit_shared(mut self) {
        match self.run("COMMIT").await {
            Ok(()) => drop(self.outcome.set(Ok(()))),
            Err(error) => drop(self.fail_transaction(error)),
        }
    }

    /// Fails the transaction for all of its parts, and closes the connection, as its state is not
    /// known.
    fn fail_transaction(self, error: sqlx::Error) -> sqlx::Error {
        let text = error.to_string();
        // With a full disk, SQLite rolls back the whole transaction by itself, and the savepoint is
        // gone.
        let full = is_full(&error) || text.contains("no such savepoint");
        let _ = self.outcome.set(Err(CommitFailure { text, full }));
        drop(self.connection.detach());
        error
    }
}

impl CommitFailure {
    fn to_error(&self) -> sqlx::Error {
        let error = not_kept(&self.text);
        match self.full {
            true => sqlx::Error::Io(io::Error::new(io::ErrorKind::StorageFull, error)),
            false => error,
        }
    }
}

fn not_kept(reason: &str) -> sqlx::Error {
    sqlx::Error::Protocol(format!("the transaction was rolled back: {reason}"))
}

/// Runs work to its end even if the caller is cancelled: a future that is dropped between two
/// statements would leave half a transaction.
async fn run_uninterrupted<T: Send + 'static>(
    work: impl Future<Output = sqlx::Result<T>> + Send + 'static,
) -> sqlx::Result<T> {
    match tokio::spawn(work).await {
        Ok(done) => done,
        Err(error) => Err(not_kept(&error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use sqlx::sqlite::SqlitePoolOptions;

    use super::*;

    async fn group() -> (WriterGroup, SqlitePool) {
        let pool =
            SqlitePoolOptions::new().max_connections(1).connect("sqlite::memory:").await.unwrap();
        sqlx::query("CREATE TABLE kept (n INTEGER PRIMARY KEY)").execute(&pool).await.unwrap();
        (WriterGroup::new(pool.clone()), pool)
    }

    async fn put(part: &mut TransactionPart, n: i64) -> sqlx::Result<()> {
        sqlx::query("INSERT INTO kept VALUES ($1)")
            .bind(n)
            .execute(part.connection()?)
            .await
            .map(drop)
    }

    async fn kept(pool: &SqlitePool) -> Vec<i64> {
        sqlx::query_scalar("SELECT n FROM kept ORDER BY n").fetch_all(pool).await.unwrap()
    }

    #[tokio::test]
    async fn those_who_wait_share_a_commit_and_one_undone_takes_nothing_from_the_others() {
        let (group, pool) = group().await;
        let mut first = group.begin().await.unwrap();
        let others = [2, 3, 4].map(|n| {
            let group = group.clone();
            tokio::spawn(async move {
                let mut part = group.begin().await?;
                put(&mut part, n).await?;
                // The third changes its mind.
                if n == 3 { Ok(()) } else { part.commit().await }
            })
        });
        put(&mut first, 1).await.unwrap();
        tokio::time::sleep(Duration::from_millis(50)).await;
        first.commit().await.unwrap();
        for other in others {
            other.await.unwrap().unwrap();
        }
        assert_eq!(kept(&pool).await, [1, 2, 4]);
    }

    #[tokio::test]
    async fn whoever_fails_or_gives_up_leaves_the_turn_to_others() {
        let (group, pool) = group().await;
        let mut part = group.begin().await.unwrap();
        put(&mut part, 1).await.unwrap();
        assert!(put(&mut part, 1).await.is_err());
        drop(part);
        let mut part = group.begin().await.unwrap();
        let waiting = tokio::time::timeout(Duration::from_millis(20), group.begin()).await;
        assert!(waiting.is_err());
        put(&mut part, 2).await.unwrap();
        // A writer that does not wait for the answer has written all the same.
        drop(tokio::time::timeout(Duration::ZERO, part.commit()).await);
        let mut part = group.begin().await.unwrap();
        put(&mut part, 3).await.unwrap();
        part.commit().await.unwrap();
        assert_eq!(kept(&pool).await, [2, 3]);
    }

    #[test]
    fn a_part_dropped_outside_of_a_runtime_is_rolled_back() {
        let runtime = tokio::runtime::Runtime::new().unwrap();
        let (group, pool, part) = runtime.block_on(async {
            let (group, pool) = group().await;
            let mut part = group.begin().await.unwrap();
            put(&mut part, 1).await.unwrap();
            (group, pool, part)
        });
        drop(part);
        runtime.block_on(async {
            let mut part = group.begin().await.unwrap();
            put(&mut part, 2).await.unwrap();
            part.commit().await.unwrap();
            assert_eq!(kept(&pool).await, [2]);
        });
        let part = runtime.block_on(group.begin()).unwrap();
        runtime.shutdown_background();
        drop(part);
    }

    #[tokio::test]
    async fn a_transaction_that_fails_is_kept_for_nobody() {
        let (group, pool) = group().await;
        let mut first = group.begin().await.unwrap();
        put(&mut first, 1).await.unwrap();
        let second = tokio::spawn({
            let group = group.clone();
            async move {
                let mut part = group.begin().await?;
                // As the database does by itself where the disk is full.
                sqlx::query("ROLLBACK").execute(part.connection()?).await?;
                part.commit().await
            }
        });
        tokio::time::sleep(Duration::from_millis(50)).await;
        let reason = first.commit().await.unwrap_err().to_string();
        assert!(reason.contains("was rolled back"), "{reason}");
        assert!(second.await.unwrap().is_err());
        drop(pool);
    }
}
