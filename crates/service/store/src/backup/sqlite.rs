//! Backup of an SQLite database by `VACUUM INTO`: one read transaction of SQLite, during which
//! writers continue; the result is one compact file without a write-ahead log.

use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions as _, Connection as _, SqlitePool};

use super::content::{DatabaseCopy, DatabaseKind, OBJECT_KEYS};
use super::files::{file_error, write_whole};
use crate::error::{Result, StoreError};
use crate::folders;

const FILE: &str = "database.sqlite";

pub(crate) async fn copy_database(pool: &SqlitePool, folder: &Path) -> Result<DatabaseCopy> {
    let file: String =
        sqlx::query_scalar("SELECT file FROM pragma_database_list WHERE name = 'main'")
            .fetch_one(pool)
            .await?;
    if file.is_empty() {
        return Err(StoreError::invalid(
            "database_url",
            "a database in memory cannot be backed up",
        ));
    }
    let path = folder.join(FILE);
    let into =
        path.to_str().ok_or_else(|| StoreError::invalid("folder", "its path must be UTF-8"))?;
    // A separate connection, so that neither readers nor the writer wait for the copy.
    let mut connection = pool.connect_options().as_ref().clone().connect().await?;
    sqlx::query("VACUUM INTO $1").bind(into).execute(&mut connection).await?;
    connection.close().await?;
    std::fs::File::open(&path).and_then(|file| file.sync_all()).map_err(file_error(&path))?;
    describe_copy(&path).await
}

/// Reads schema and object keys from the copy itself, so that they belong to the same moment.
async fn describe_copy(path: &Path) -> Result<DatabaseCopy> {
    // Immutable: no lock and no log file is created next to the copy.
    let options = SqliteConnectOptions::new().filename(path).read_only(true).immutable(true);
    let mut connection = options.connect().await?;
    let keys = sqlx::query_scalar(OBJECT_KEYS).fetch_all(&mut connection).await?;
    let schema = sqlx::query_scalar("SELECT MAX(version) FROM _sqlx_migrations")
        .fetch_one(&mut connection)
        .await?;
    connection.close().await?;
    Ok(DatabaseCopy {
        kind: DatabaseKind::Sqlite,
        schema,
        files: vec![FILE.to_owned()],
        tables: Vec::new(),
        keys,
    })
}

fn file_of(url: &str) -> Result<PathBuf> {
    Ok(SqliteConnectOptions::from_str(url)?.get_filename().to_path_buf())
}

pub(crate) fn must_be_absent(url: &str) -> Result<()> {
    let file = file_of(url)?;
    match file.exists() {
        true => Err(StoreError::conflict(
            "database",
            file.display().to_string(),
            "exists already; restore the backup to an empty place",
        )),
        false => Ok(()),
    }
}

pub(crate) async fn restore_database(folder: &Path, url: &str) -> Result<()> {
    let (from, to) = (folder.join(FILE), file_of(url)?);
    to.parent().map_or(Ok(()), folders::create_durably).map_err(file_error(&to))?;
    let copying = tokio::task::spawn_blocking(move || {
        write_whole(&to, |path| std::fs::copy(&from, path).map(drop))
    });
    copying.await.map_err(crate::objects_error::ObjectsError::from)?
}
