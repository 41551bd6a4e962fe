//! The connections to PostgreSQL. Where one does not answer in time, all of them are given up and
//! further ones are new: after a fail-over, or behind a firewall that has forgotten them, none of
//! them ever answers again, and nothing tells of it.

use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;

use futures::FutureExt as _;
use futures::future::BoxFuture;
use sqlx::PgPool;

use crate::error::Result;

/// How long a statement may take, or the wait for a connection: the longest of ours takes a second
/// on a hundred thousand ships.
const DEADLINE: Duration = Duration::from_secs(8);

/// The connections to PostgreSQL.
#[derive(Clone)]
pub(crate) struct PostgresPool(Arc<Shared>);

struct Shared {
    fresh: Box<dyn Fn() -> PgPool + Send + Sync>,
    current: RwLock<Current>,
}

#[derive(Clone)]
struct Current {
    generation: u64,
    pool: PgPool,
}

/// The connections as they are now, for one piece of work.
#[derive(Clone)]
pub(crate) struct Lease {
    shared: PostgresPool,
    generation: u64,
    /// The connections.
    pub(crate) pool: PgPool,
}

impl std::fmt::Debug for PostgresPool {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PostgresPool").finish_non_exhaustive()
    }
}

impl PostgresPool {
    /// Connections as `fresh` makes them, the first of which are `pool`.
    pub(crate) fn new(pool: PgPool, fresh: impl Fn() -> PgPool + Send + Sync + 'static) -> Self {
        let current = RwLock::new(Current { generation: 0, pool });
        Self(Arc::new(Shared { fresh: Box::new(fresh), current }))
    }

    /// The connections as they are now.
    pub(crate) fn lease(&self) -> Lease {
        let current = self.0.current.read().unwrap_or_else(PoisonError::into_inner).clone();
        Lease { shared: self.clone(), generation: current.generation, pool: current.pool }
    }

    /// Ends all connections.
    pub(crate) async fn close(&self) {
        self.lease().pool.close().await;
    }
}

impl Lease {
    /// Does something within the deadline, after which these connections are given up. The work is
    /// boxed: as a part of each caller's own future it would need much of a thread's stack.
    pub(crate) fn within<'a, T: Send + 'a>(
        &'a self,
        work: impl Future<Output = Result<T, sqlx::Error>> + Send + 'a,
    ) -> BoxFuture<'a, Result<T>> {
        let work = work.boxed();
        let done = async move {
            match tokio::time::timeout(DEADLINE, work).await {
                Ok(done) => Ok(done?),
                Err(_) => {
                    self.give_up();
                    let silent =
                        "the database did not answer in time; connections to it are new now";
                    let kind = std::io::ErrorKind::TimedOut;
                    Err(sqlx::Error::Io(std::io::Error::new(kind, silent)).into())
                }
            }
        };
        done.boxed()
    }

    /// Replaces these connections, unless somebody has done so.
    fn give_up(&self) {
        let shared = &self.shared.0;
        let mut current = shared.current.write().unwrap_or_else(PoisonError::into_inner);
        if current.generation != self.generation {
            return;
        }
        let old = current.pool.clone();
        *current = Current { generation: self.generation + 1, pool: (shared.fresh)() };
        // Whoever waits for one of them is told at once; those that are silent end when they may.
        tokio::spawn(async move { old.close().await });
    }
}
