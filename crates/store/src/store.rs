//! The store: one database, a clock, a maker of ids, and a repository per table.

use std::fmt;
use std::sync::Arc;

use crate::aliases::Aliases;
use crate::bulks::Bulks;
use crate::clock::{Clock, Ids, UuidIds};
use crate::connect;
use crate::current::Questions;
use crate::database::{Database, Transaction};
use crate::diagnoses::Diagnoses;
use crate::effects::EffectLibraries;
use crate::error::Result;
use crate::families::Families;
use crate::idempotency::Idempotency;
use crate::jobs::Jobs;
use crate::laws::Laws;
use crate::record::record;
use crate::reports::Reports;
use crate::reserve;
use crate::search_index::SearchIndex;
use crate::ships::Ships;
use crate::statements::{same, statements};
use crate::statistics::TrialStatistics;
use crate::trials::Trials;
use crate::unit::Unit;
use crate::versions::Versions;

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
pub struct Store(Arc<Inner>);

struct Inner {
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
    /// Opens `sqlite://path/file.db`, `sqlite::memory:` or `postgres://...` and brings its schema up to date; several
    /// processes may do so at once.
    pub async fn connect(url: &str, clock: Arc<dyn Clock>) -> Result<Self> {
        Self::connect_with(url, clock, Arc::new(UuidIds::default())).await
    }

    /// The same, with ids made by `ids`.
    pub async fn connect_with(url: &str, clock: Arc<dyn Clock>, ids: Arc<dyn Ids>) -> Result<Self> {
        let database = match connect::connect(url).await {
            Err(error) if error.is_out_of_space() && reserve::release(url) => connect::connect(url).await?,
            other => other?,
        };
        Ok(Self::of(Inner {
            database,
            clock,
            ids,
            questions: Questions::default(),
            reserve: reserve::of(url),
            #[cfg(feature = "testing")]
            ending: Arc::default(),
        }))
    }

    fn of(inner: Inner) -> Self {
        Self(Arc::new(inner))
    }

    /// A handle whose reads and writes belong to a unit of work.
    pub(crate) fn within(&self, unit: Unit) -> Self {
        let Inner { database, clock, ids, .. } = &*self.0;
        Self::of(Inner {
            database: Database { unit: Some(unit), ..database.clone() },
            clock: Arc::clone(clock),
            ids: Arc::clone(ids),
            questions: Questions::default(),
            reserve: self.0.reserve.clone(),
            #[cfg(feature = "testing")]
            ending: Arc::clone(&self.0.ending),
        })
    }

    /// The next unit of work goes no further than this moment, as if its process had ended: for tests.
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

    /// Whether the database answers.
    pub async fn health(&self) -> Result<()> {
        self.database().optional::<Pong>(PING, &[]).await.map(drop)
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

    /// Laws of motion, insert-only.
    pub fn laws(&self) -> Laws<'_> {
        Laws(self)
    }

    /// Libraries of effects, insert-only.
    pub fn effects(&self) -> EffectLibraries<'_> {
        EffectLibraries(self)
    }

    /// Ships and their history.
    pub fn ships(&self) -> Ships<'_> {
        Ships(self)
    }

    /// Trials of ships; their samples are [`crate::Objects`].
    pub fn trials(&self) -> Trials<'_> {
        Trials(self)
    }

    /// Versions of models, insert-only.
    pub fn versions(&self) -> Versions<'_> {
        Versions(self)
    }

    /// Names for versions that move, and how they have moved.
    pub fn aliases(&self) -> Aliases<'_> {
        Aliases(self)
    }

    /// Requests that must not be carried out twice.
    pub fn idempotency(&self) -> Idempotency<'_> {
        Idempotency(self)
    }

    /// Long work.
    pub fn jobs(&self) -> Jobs<'_> {
        Jobs(self)
    }

    /// Reports on versions and ships.
    pub fn reports(&self) -> Reports<'_> {
        Reports(self)
    }

    /// What ships are found by.
    pub fn search_index(&self) -> SearchIndex<'_> {
        SearchIndex(self)
    }

    /// Diagnoses of versions.
    pub fn diagnoses(&self) -> Diagnoses<'_> {
        Diagnoses(self)
    }

    /// Families of ships.
    pub fn families(&self) -> Families<'_> {
        Families(self)
    }

    /// Refinements of whole families.
    pub fn bulks(&self) -> Bulks<'_> {
        Bulks(self)
    }

    /// Sufficient statistics of trials.
    pub fn statistics(&self) -> TrialStatistics<'_> {
        TrialStatistics(self)
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
