//! Databases for tests: a temporary SQLite file, and a fresh database on a private PostgreSQL
//! server.

use std::str::FromStr as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{AssertSqlSafe, ConnectOptions as _, Connection as _, Executor as _, PgConnection};
use tempfile::TempDir;

pub use s3::{FaultyBucket, TestS3};

use crate::backup::TABLES;
use crate::clock::ManualClock;
use crate::connections::ReadPool;
use crate::store::Store;

mod plans;
mod s3;
mod server;

/// An empty database that is removed when this is dropped (on PostgreSQL, when the test process
/// ends).
#[derive(Debug)]
pub struct TestDatabase {
    /// URL of the database.
    pub url: String,
    /// A folder for this test alone.
    pub folder: TempDir,
}

impl TestDatabase {
    /// Creates a new SQLite file.
    pub fn new_sqlite() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        Self { url: format!("sqlite://{}", folder.path().join("store.db").display()), folder }
    }

    /// Creates a database on the private PostgreSQL server of this process. Returns none, with a
    /// message, if PostgreSQL is not installed, unless `SISTERSHIP_REQUIRE_POSTGRES=1`, which makes
    /// that a failure.
    pub async fn new_postgres() -> Option<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let server = server::shared_server()?;
        let name = format!("test_{}", COUNT.fetch_add(1, Ordering::SeqCst));
        let mut connection = server
            .connect_options()
            .connect()
            .await
            .expect("a connection to the private PostgreSQL server");
        create_database(&mut connection, &name).await.expect("a new database");
        connection.close().await.expect("the end of a connection");
        Some(Self {
            url: server.database_url(&name),
            folder: tempfile::tempdir().expect("a temporary folder"),
        })
    }

    /// Opens the database with a clock that stands still.
    pub async fn open(self) -> TestStore {
        let clock = Arc::new(ManualClock::new(1_800_000_000_000_000));
        let store = Store::connect(&self.url, clock.clone()).await.expect("a store");
        TestStore { store, clock, database: self }
    }
}

impl TestDatabase {
    /// Executes a statement that no valid program would: without triggers and without foreign keys.
    pub async fn execute_unchecked(&self, sql: &str) {
        match self.url.starts_with("sqlite") {
            true => self.damage_sqlite(sql).await,
            false => self.damage_postgres(sql).await,
        }
        // Triggers refuse changes of immutable rows, and foreign keys missing references: both are
        // disabled.
        .expect("a damaged database");
    }

    async fn damage_sqlite(&self, sql: &str) -> sqlx::Result<()> {
        let options = SqliteConnectOptions::from_str(&self.url)?.foreign_keys(false);
        let mut connection = options.connect().await?;
        let triggers = sqlx::query_scalar::<_, String>(
            "SELECT name FROM sqlite_master WHERE type = 'trigger'",
        );
        for trigger in triggers.fetch_all(&mut connection).await? {
            connection.execute(AssertSqlSafe(format!("DROP TRIGGER {trigger}"))).await?;
        }
        connection.execute(AssertSqlSafe(sql.to_owned())).await.map(drop)
    }

    async fn damage_postgres(&self, sql: &str) -> sqlx::Result<()> {
        let mut connection = PgConnection::connect(&self.url).await?;
        // In this role no triggers and no checks of foreign keys are executed.
        connection.execute("SET session_replication_role = replica").await?;
        connection.execute(AssertSqlSafe(sql.to_owned())).await.map(drop)
    }
}

/// A lock on a table of a PostgreSQL database, which can be read but not written until this is
/// dropped.
#[derive(Debug)]
pub struct HeldTable(#[expect(dead_code, reason = "the lock is its connection's")] PgConnection);

impl TestDatabase {
    /// Blocks writers to a table of a PostgreSQL database until the returned value is dropped.
    pub async fn hold_writes(&self, table: &str) -> HeldTable {
        let mut connection = PgConnection::connect(&self.url).await.expect("a connection");
        // The transaction stays open, and with it the lock, until the connection is dropped.
        let held = format!("BEGIN; LOCK TABLE {table} IN EXCLUSIVE MODE");
        connection.execute(AssertSqlSafe(held)).await.expect("a lock on the table");
        HeldTable(connection)
    }
}

/// Creates a database with an English collation, where the server supports it (from PostgreSQL 15):
/// the order of keys must not depend on it.
async fn create_database(connection: &mut PgConnection, name: &str) -> sqlx::Result<()> {
    let plain = format!("CREATE DATABASE {name} TEMPLATE template0");
    let sorted = format!("{plain} LOCALE_PROVIDER icu ICU_LOCALE 'en'");
    match connection.execute(AssertSqlSafe(sorted)).await {
        Ok(_) => Ok(()),
        Err(_) => connection.execute(AssertSqlSafe(plain)).await.map(drop),
    }
}

impl Store {
    /// Returns the number of rows of each table, except those that are written in the background.
    pub async fn row_counts(&self) -> sqlx::Result<Vec<(&'static str, i64)>> {
        let mut counts = Vec::new();
        let kept = |table: &&&str| {
            let in_background = ["ship_facts", "ship_vectors", "search_queue", "trial_statistics"];
            !in_background.contains(*table) && **table != "idempotency_keys"
        };
        for table in TABLES.iter().filter(kept) {
            let count = AssertSqlSafe(format!("SELECT COUNT(*) FROM {table}"));
            let rows = match &self.database().read {
                ReadPool::Sqlite(pool) => sqlx::query_scalar(count).fetch_one(pool).await?,
                ReadPool::Postgres(pool) => {
                    sqlx::query_scalar(count).fetch_one(&pool.current_lease().pool).await?
                }
            };
            counts.push((*table, rows));
        }
        Ok(counts)
    }
}

/// A store on an empty database.
#[derive(Debug)]
pub struct TestStore {
    /// The store.
    pub store: Store,
    /// Its clock.
    pub clock: Arc<ManualClock>,
    /// Its database.
    pub database: TestDatabase,
}
