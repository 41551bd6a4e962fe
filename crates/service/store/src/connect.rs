//! Opening a database by its URL.

use std::path::PathBuf;
use std::str::FromStr as _;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgPoolOptions};
use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};
use sqlx::{Connection as _, PgPool, SqlitePool};

use crate::connections::{DatabaseWriter, IDLE_BEFORE_PING, ReadPool};
use crate::database::Database;
use crate::error::{Result, StoreError};
use crate::folders;
use crate::group::WriterGroup;
use crate::migrate;
use crate::postgres_pool::PostgresPool;
use crate::queue_signal::QueueSignal;

const BUSY_TIMEOUT: Duration = Duration::from_secs(10);
const SQLITE_READERS: u32 = 4;
const POSTGRES_CONNECTIONS: u32 = 16;
/// Maximum wait for a connection, including that for the server.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(6);
/// Maximum wait for the answer of a connection that was idle.
const PING_TIMEOUT: Duration = Duration::from_secs(1);
/// Settings of a session, by which the server gives up what this program has given up. Otherwise a
/// transaction whose connection went silent keeps its locks, and nothing can be written until the
/// server notices, by default after two hours. A transaction waits for the program between two
/// statements for at most 6 s, and for a lock a little less than the program waits for the
/// statement, so that a lock that is held is not taken for a silent connection.
const POSTGRES_SESSION: [(&str, &str); 5] = [
    ("idle_in_transaction_session_timeout", "6s"),
    ("lock_timeout", "7s"),
    ("tcp_keepalives_idle", "10"),
    ("tcp_keepalives_interval", "5"),
    ("tcp_keepalives_count", "3"),
];

/// Opens the database at `url` and brings its schema up to date.
pub(crate) async fn connect_database(url: &str) -> Result<Database> {
    match url.split_once(':') {
        Some(("sqlite", _)) if url.contains(":memory:") => open_memory(url).await,
        Some(("sqlite", _)) => open_file(url).await,
        Some(("postgres" | "postgresql", _)) => open_postgres(url).await,
        _ => Err(StoreError::invalid("database_url", "must begin with sqlite: or postgres:")),
    }
}

/// Returns the file of an SQLite database; none for other databases.
pub(crate) fn sqlite_file(url: &str) -> Option<PathBuf> {
    let is_file = url.starts_with("sqlite:") && !url.contains(":memory:");
    let options = is_file.then(|| SqliteConnectOptions::from_str(url).ok()).flatten()?;
    Some(options.get_filename().to_path_buf())
}

/// Opens a database in memory, with one connection that lasts as long as the store: the data would
/// be lost with it.
async fn open_memory(url: &str) -> Result<Database> {
    let options = SqliteConnectOptions::from_str(url)?.foreign_keys(true);
    let pool = SqlitePoolOptions::new()
        .max_connections(1)
        .min_connections(1)
        .idle_timeout(None)
        .max_lifetime(None);
    let pool = pool.connect_with(options).await?;
    migrate::migrate_sqlite(&pool).await?;
    Ok(Database {
        read: ReadPool::Sqlite(pool.clone()),
        write: DatabaseWriter::Sqlite(WriterGroup::new(pool)),
        unit: None,
        queue: QueueSignal::default(),
    })
}

async fn open_file(url: &str) -> Result<Database> {
    let options =
        SqliteConnectOptions::from_str(url)?.foreign_keys(true).busy_timeout(BUSY_TIMEOUT);
    options
        .get_filename()
        .parent()
        .map_or(Ok(()), folders::create_durably)
        .map_err(sqlx::Error::Io)?;
    // Write-ahead log with full sync: an acknowledged commit survives a power failure, and readers
    // do not wait for the writer.
    let write = options.clone().create_if_missing(true).synchronous(SqliteSynchronous::Full);
    let write = open_writer(write.journal_mode(SqliteJournalMode::Wal)).await?;
    migrate::migrate_sqlite(&write).await?;
    // A connection to a file does not go stale.
    let readers =
        SqlitePoolOptions::new().max_connections(SQLITE_READERS).test_before_acquire(false);
    let read = readers.connect_with(options.pragma("query_only", "ON")).await?;
    Ok(Database {
        read: ReadPool::Sqlite(read),
        write: DatabaseWriter::Sqlite(WriterGroup::new(write)),
        unit: None,
        queue: QueueSignal::default(),
    })
}

/// Opens the one connection that writes. Switching to the write-ahead log needs the file
/// exclusively and ignores the busy timeout, so that two processes which open a new file at once
/// have to retry.
async fn open_writer(options: SqliteConnectOptions) -> Result<SqlitePool> {
    let mut tries = 100;
    loop {
        let pool = SqlitePoolOptions::new()
            .max_connections(1)
            .test_before_acquire(false)
            .connect_with(options.clone())
            .await;
        match pool {
            Err(error) if tries > 0 && is_locked(&error) => tries -= 1,
            other => return Ok(other?),
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
}

fn is_locked(error: &sqlx::Error) -> bool {
    error.as_database_error().is_some_and(|error| error.message().contains("locked"))
}

async fn open_postgres(url: &str) -> Result<Database> {
    let options = PgConnectOptions::from_str(url)?.application_name("sistership");
    // Without the settings of a session: the lock of a migration may be held for long by another
    // process.
    let migrating = postgres_options().max_connections(1).connect_with(options.clone()).await?;
    migrate::migrate_postgres(&migrating).await?;
    migrating.close().await;
    let options = options.options(POSTGRES_SESSION);
    let pool: PgPool = postgres_options().connect_with(options.clone()).await?;
    let pool =
        PostgresPool::new(pool, move || postgres_options().connect_lazy_with(options.clone()));
    Ok(Database {
        read: ReadPool::Postgres(pool.clone()),
        write: DatabaseWriter::Postgres(pool),
        unit: None,
        queue: QueueSignal::default(),
    })
}

fn postgres_options() -> PgPoolOptions {
    let pool = PgPoolOptions::new()
        .max_connections(POSTGRES_CONNECTIONS)
        .acquire_timeout(CONNECT_TIMEOUT)
        .test_before_acquire(false);
    // A connection that was used a moment ago is valid; a ping each time would cost as much as the
    // query. One that does not answer is replaced.
    pool.before_acquire(|connection, about| {
        Box::pin(async move {
            if about.idle_for <= IDLE_BEFORE_PING {
                return Ok(true);
            }
            let silent = || sqlx::Error::Io(std::io::ErrorKind::TimedOut.into());
            let answered = tokio::time::timeout(PING_TIMEOUT, connection.ping()).await;
            answered.map_err(|_| silent())?.map(|()| true)
        })
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    async fn pragma(pool: &SqlitePool, sql: &'static str) -> String {
        sqlx::query_scalar(sql).fetch_one(pool).await.unwrap()
    }

    #[tokio::test]
    async fn a_sqlite_file_is_durable_and_its_readers_only_read() {
        let folder = tempfile::tempdir().unwrap();
        let url = format!("sqlite://{}", folder.path().join("new/store.db").display());
        let Database { read: ReadPool::Sqlite(read), write: DatabaseWriter::Sqlite(write), .. } =
            connect_database(&url).await.unwrap()
        else {
            panic!()
        };
        let write = write.pool();
        assert_eq!(pragma(write, "SELECT journal_mode FROM pragma_journal_mode").await, "wal");
        assert_eq!(
            pragma(write, "SELECT CAST(synchronous AS TEXT) FROM pragma_synchronous").await,
            "2"
        );
        assert_eq!(
            pragma(write, "SELECT CAST(foreign_keys AS TEXT) FROM pragma_foreign_keys").await,
            "1"
        );
        assert_eq!(
            pragma(&read, "SELECT CAST(query_only AS TEXT) FROM pragma_query_only").await,
            "1"
        );
    }
}
