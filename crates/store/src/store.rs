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
use crate::search_index::SearchIndex;
use crate::ships::Ships;
use crate::statements::{same, statements};
use crate::statistics::TrialStatistics;
use crate::trials::Trials;
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
        let database = connect::connect(url).await?;
        Ok(Self(Arc::new(Inner { database, clock, ids, questions: Questions::default() })))
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
