//! The store: one database, a clock and a maker of ids. Each repository is reached from it by a
//! method that stands in the repository's own file.

use std::fmt;
use std::sync::Arc;

use crate::clock::{Clock, Ids, UuidIds};
use crate::connect;
use crate::database::{Database, Transaction};
use crate::error::Result;
use crate::questions::Questions;
use crate::record::record;
use crate::reserve;
use crate::statements::{same, statements};
use crate::unit::Unit;

/// How long the database may take to say that it is there.
const SOON: std::time::Duration = std::time::Duration::from_millis(800);

statements! {
    PING = same("SELECT CAST(1 AS BIGINT) AS alive");
}

record! {
    /// The answer to a ping.
    pub struct Pong {
        /// 1.
        pub alive: i64,
    }
}

/// The database of Sistership. A clone is another handle on the same connections.
#[derive(Clone)]
pub struct Store(Arc<StoreParts>);

struct StoreParts {
    database: Database,
    clock: Arc<dyn Clock>,
    ids: Arc<dyn Ids>,
    questions: Questions,
    /// The file that keeps room for the next start.
    reserve: Option<std::path::PathBuf>,
    /// Where a test wants a unit of work to end.
    #[cfg(feature = "testing")]
    ending: Arc<std::sync::Mutex<Option<crate::unit::Moment>>>,
}

impl fmt::Debug for Store {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Store").field("database", &self.0.database).finish_non_exhaustive()
    }
}

impl Store {
    /// Opens `sqlite://path/file.db`, `sqlite::memory:` or `postgres://...` and brings its schema
    /// up to date; several processes may do so at once.
    pub async fn connect(url: &str, clock: Arc<dyn Clock>) -> Result<Self> {
        Self::connect_with(url, clock, Arc::new(UuidIds::default())).await
    }

    /// The same, with ids made by `ids`.
    pub async fn connect_with(url: &str, clock: Arc<dyn Clock>, ids: Arc<dyn Ids>) -> Result<Self> {
        let database = match connect::connect(url).await {
            Err(error) if error.is_out_of_space() && reserve::release(url) => {
                connect::connect(url).await?
            }
            other => other?,
        };
        Ok(Self::of(StoreParts {
            database,
            clock,
            ids,
            questions: Questions::default(),
            reserve: reserve::of(url),
            #[cfg(feature = "testing")]
            ending: Arc::default(),
        }))
    }

    fn of(parts: StoreParts) -> Self {
        Self(Arc::new(parts))
    }

    /// A handle whose reads and writes belong to a unit of work.
    pub(crate) fn within(&self, unit: Unit) -> Self {
        let StoreParts { database, clock, ids, .. } = &*self.0;
        Self::of(StoreParts {
            database: Database { unit: Some(unit), ..database.clone() },
            clock: Arc::clone(clock),
            ids: Arc::clone(ids),
            questions: Questions::default(),
            reserve: self.0.reserve.clone(),
            #[cfg(feature = "testing")]
            ending: Arc::clone(&self.0.ending),
        })
    }

    /// The next unit of work goes no further than this moment, as if its process had ended: for
    /// tests.
    #[cfg(feature = "testing")]
    pub fn end_at(&self, moment: crate::unit::Moment) {
        *self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(moment);
    }

    /// Whether no unit of work is still to end so.
    #[cfg(feature = "testing")]
    pub fn has_ended(&self) -> bool {
        self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner).is_none()
    }

    #[cfg(feature = "testing")]
    pub(crate) fn is_to_end_at(&self, moment: crate::unit::Moment) -> bool {
        let mut ending = self.0.ending.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        ending.take_if(|at| *at == moment).is_some()
    }

    /// Whether the database answers, and soon.
    pub async fn health(&self) -> Result<()> {
        let answered = tokio::time::timeout(SOON, self.database().optional::<Pong>(PING, &[]));
        let late = |_| sqlx::Error::Io(std::io::ErrorKind::TimedOut.into());
        answered.await.map_err(late)?.map(drop)
    }

    /// Ends all connections once what is under way has ended.
    pub async fn close(&self) {
        self.questions().close();
        self.database().close().await;
    }

    /// The clock that this store goes by, in microseconds since 1970.
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

    pub(crate) fn questions(&self) -> &Questions {
        &self.0.questions
    }

    pub(crate) async fn begin(&self) -> Result<Transaction> {
        self.database().begin().await
    }
}
