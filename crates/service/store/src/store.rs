//! The store: one database, a clock and a generator of ids. Each repository is reached by a method
//! of [`Store`] that is defined in the repository's own file.

use std::fmt;
use std::sync::Arc;

use crate::alias_lookups::LookupQueue;
use crate::clock::{Clock, IdGenerator, UuidIds};
use crate::connect;
use crate::database::{AuditedTransaction, Database};
use crate::error::Result;
use crate::record::record;
use crate::reserve;
use crate::statements::{same, statements};
use crate::unit::UnitTransaction;

/// Maximum time of the health check of the database.
const HEALTH_TIMEOUT: std::time::Duration = std::time::Duration::from_millis(800);

statements! {
    PING = same("SELECT CAST(1 AS BIGINT) AS alive");
}

record! {
    /// The answer to a ping.
    pub struct PingRow {
        /// Always 1.
        pub alive: i64,
    }
}

/// The database of Sistership. A clone is another handle on the same connections.
#[derive(Clone)]
pub struct Store(Arc<StoreParts>);

struct StoreParts {
    database: Database,
    clock: Arc<dyn Clock>,
    ids: Arc<dyn IdGenerator>,
    questions: LookupQueue,
    /// File of the reserved space for the next start.
    reserve: Option<std::path::PathBuf>,
    /// Moment at which a test wants the next unit of work to stop.
    #[cfg(feature = "testing")]
    ending: Arc<std::sync::Mutex<Option<crate::unit::CrashPoint>>>,
}

impl fmt::Debug for Store {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Store").field("database", &self.0.database).finish_non_exhaustive()
    }
}

impl Store {
    /// Opens `sqlite://path/file.db`, `sqlite::memory:` or `postgres://...` and migrates its
    /// schema; several processes may do so at the same time.
    pub async fn connect(url: &str, clock: Arc<dyn Clock>) -> Result<Self> {
        Self::connect_with(url, clock, Arc::new(UuidIds::default())).await
    }

    /// Opens a database as [`Self::connect`] does, with a generator of ids.
    pub async fn connect_with(
        url: &str,
        clock: Arc<dyn Clock>,
        ids: Arc<dyn IdGenerator>,
    ) -> Result<Self> {
        let database = match connect::connect_database(url).await {
            // A full disk: the reserved space is freed, and the database opened once more.
            Err(error) if error.is_out_of_space() && reserve::release_space(url) => {
                connect::connect_database(url).await?
            }
            other => other?,
        };
        Ok(Self::from_parts(StoreParts {
            database,
            clock,
            ids,
            questions: LookupQueue::default(),
            reserve: reserve::reserve_path(url),
            #[cfg(feature = "testing")]
            ending: Arc::default(),
        }))
    }

    fn from_parts(parts: StoreParts) -> Self {
        Self(Arc::new(parts))
    }

    /// Returns a handle whose reads and writes belong to a unit of work.
    pub(crate) fn with_unit(&self, unit: UnitTransaction) -> Self {
        let StoreParts { database, clock, ids, .. } = &*self.0;
        Self::from_parts(StoreParts {
            database: Database { unit: Some(unit), ..database.clone() },
            clock: Arc::clone(clock),
            ids: Arc::clone(ids),
            // Not used: the lookups of a unit of work are not batched.
            questions: LookupQueue::default(),
            reserve: self.0.reserve.clone(),
            #[cfg(feature = "testing")]
            ending: Arc::clone(&self.0.ending),
        })
    }

    /// Stops the next unit of work at a moment, as if its process had ended; for tests.
    #[cfg(feature = "testing")]
    pub fn end_at(&self, moment: crate::unit::CrashPoint) {
        *self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(moment);
    }

    /// Returns true if no unit of work is still to be stopped by [`Self::end_at`].
    #[cfg(feature = "testing")]
    pub fn has_ended(&self) -> bool {
        self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner).is_none()
    }

    #[cfg(feature = "testing")]
    pub(crate) fn is_to_end_at(&self, moment: crate::unit::CrashPoint) -> bool {
        let mut ending = self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        ending.take_if(|at| *at == moment).is_some()
    }

    /// Checks that the database answers in a short time.
    pub async fn check_health(&self) -> Result<()> {
        let answered = tokio::time::timeout(
            HEALTH_TIMEOUT,
            self.database().fetch_optional::<PingRow>(PING, &[]),
        );
        let late = |_| sqlx::Error::Io(std::io::ErrorKind::TimedOut.into());
        answered.await.map_err(late)?.map(drop)
    }

    /// Closes all connections once the work in progress has ended.
    pub async fn close(&self) {
        self.lookup_queue().close();
        self.database().close().await;
    }

    /// Returns the present time of the store's clock, microseconds since 1970.
    pub fn now_us(&self) -> i64 {
        self.0.clock.now_us()
    }

    pub(crate) fn reserve_file(&self) -> Option<&std::path::Path> {
        self.0.reserve.as_deref()
    }

    pub(crate) fn new_id(&self) -> String {
        self.0.ids.new_id(self.now_us())
    }

    pub(crate) fn database(&self) -> &Database {
        &self.0.database
    }

    pub(crate) fn lookup_queue(&self) -> &LookupQueue {
        &self.0.questions
    }

    pub(crate) async fn begin(&self) -> Result<AuditedTransaction> {
        self.database().begin().await
    }
}
