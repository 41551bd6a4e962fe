//! Pool of connections to PostgreSQL. When one of them does not answer in time, the whole pool is
//! replaced: after a fail-over, or behind a firewall that has dropped them, none of the old
//! connections ever answers again, and no error is reported.

use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;

use futures::FutureExt as _;
use futures::future::BoxFuture;
use sqlx::PgPool;

use crate::error::Result;

/// Maximum time of a statement, or of the wait for a connection; the slowest statement takes a
/// second with a hundred thousand ships.
const DEADLINE: Duration = Duration::from_secs(8);

/// Replaceable pool of connections to PostgreSQL.
#[derive(Clone)]
pub(crate) struct PostgresPool(Arc<SharedPool>);

struct SharedPool {
    fresh: Box<dyn Fn() -> PgPool + Send + Sync>,
    current: RwLock<PoolGeneration>,
}

#[derive(Clone)]
struct PoolGeneration {
    generation: u64,
    pool: PgPool,
}

/// The present pool, for one piece of work.
#[derive(Clone)]
pub(crate) struct PoolLease {
    shared: PostgresPool,
    generation: u64,
    /// The pool of this generation.
    pub(crate) pool: PgPool,
}

impl std::fmt::Debug for PostgresPool {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PostgresPool").finish_non_exhaustive()
    }
}

impl PostgresPool {
    /// Creates the pool; `pool` is the first one, and `fresh` makes each replacement.
    pub(crate) fn new(pool: PgPool, fresh: impl Fn() -> PgPool + Send + Sync + 'static) -> Self {
        let current = RwLock::new(PoolGeneration { generation: 0, pool });
        Self(Arc::new(SharedPool { fresh: Box::new(fresh), current }))
    }

    /// Returns the present pool.
    pub(crate) fn current_lease(&self) -> PoolLease {
        let current = self.0.current.read().unwrap_or_else(PoisonError::into_inner).clone();
        PoolLease { shared: self.clone(), generation: current.generation, pool: current.pool }
    }

    /// Closes all connections of the present pool.
    pub(crate) async fn close(&self) {
        self.current_lease().pool.close().await;
    }
}

impl PoolLease {
    /// Runs work within the deadline, after which this pool is replaced. The work is boxed: inline
    /// in the future of each caller it would need much of a thread's stack.
    pub(crate) fn within<'a, T: Send + 'a>(
        &'a self,
        work: impl Future<Output = Result<T, sqlx::Error>> + Send + 'a,
    ) -> BoxFuture<'a, Result<T>> {
        let work = work.boxed();
        let done = async move {
            // The deadline drops the work, and with it a connection in an unknown state.
            match tokio::time::timeout(DEADLINE, work).await {
                Ok(done) => Ok(done?),
                Err(_) => {
                    self.replace_pool();
                    let silent =
                        "the database did not answer in time; all connections to it were renewed";
                    let kind = std::io::ErrorKind::TimedOut;
                    Err(sqlx::Error::Io(std::io::Error::new(kind, silent)).into())
                }
            }
        };
        done.boxed()
    }

    /// Replaces this pool, unless another caller has done so.
    fn replace_pool(&self) {
        let shared = &self.shared.0;
        let mut current = shared.current.write().unwrap_or_else(PoisonError::into_inner);
        // Many statements may time out at once; only the first of them replaces the pool.
        if current.generation != self.generation {
            return;
        }
        let old = current.pool.clone();
        *current = PoolGeneration { generation: self.generation + 1, pool: (shared.fresh)() };
        // Closing ends the waits for a connection at once; silent connections end when they time
        // out.
        tokio::spawn(async move { old.close().await });
    }
}
