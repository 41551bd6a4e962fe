//! Backup of a PostgreSQL database: every table by `COPY` within one repeatable-read transaction,
//! which sees the state of one moment and does not block writers. Unlike `pg_dump` it needs no
//! programs of the server's version on this machine.

use std::path::Path;

use futures::TryStreamExt as _;
use sqlx::{Connection as _, PgConnection, PgPool};
use tokio::fs::File;
use tokio::io::AsyncWriteExt as _;

use super::content::{DatabaseCopy, DatabaseKind, OBJECT_KEYS, TableHead};
use super::files::{file_error, not_a_backup};
use super::manifest::BackupManifest;
use crate::error::{Result, StoreError};
use crate::folders;
use crate::migrate;

/// All tables, each after the tables that it refers to, so that foreign keys hold during
/// restoration.
pub(crate) const TABLES: &[&str] = &[
    "laws",
    "effect_libraries",
    "ships",
    "ship_revisions",
    "trials",
    "models",
    "versions",
    "aliases",
    "alias_moves",
    "idempotency_keys",
    "jobs",
    "reports",
    "diagnoses",
    "trial_statistics",
    "families",
    "family_members",
    "family_priors",
    "bulk_refinements",
    "bulk_chunks",
    "bulk_outcomes",
    "ship_facts",
    "ship_vectors",
    "ship_tags",
    "import_templates",
    "search_queue",
    "users",
    "grants",
    "service_keys",
    "sessions",
    "settings",
    "audit",
    "audit_head",
    "webhooks",
    "webhook_events",
    "deliveries",
    "identities",
    "spent_sign_ins",
];
const FOLDER: &str = "tables";
const COLUMNS: &str = "SELECT CAST(column_name AS TEXT) FROM information_schema.columns \
    WHERE table_schema = current_schema() AND table_name = $1 ORDER BY ordinal_position";

pub(crate) async fn copy_database(pool: &PgPool, folder: &Path) -> Result<DatabaseCopy> {
    folders::create_durably(&folder.join(FOLDER)).map_err(file_error(folder))?;
    // One snapshot for all tables, for the list of objects and for the number of the schema.
    let mut tx = pool.begin_with("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY").await?;
    let mut tables = Vec::with_capacity(TABLES.len());
    for &name in TABLES {
        // The columns are recorded, as their order may differ in the database that is restored.
        let columns = sqlx::query_scalar(COLUMNS).bind(name).fetch_all(&mut *tx).await?;
        let table = TableHead { name: name.to_owned(), columns };
        take_table(&mut tx, &table, &folder.join(file_of(&table))).await?;
        tables.push(table);
    }
    let keys = sqlx::query_scalar(OBJECT_KEYS).fetch_all(&mut *tx).await?;
    let schema =
        sqlx::query_scalar("SELECT MAX(version) FROM _sqlx_migrations").fetch_one(&mut *tx).await?;
    tx.commit().await?;
    Ok(DatabaseCopy {
        kind: DatabaseKind::Postgres,
        schema,
        files: tables.iter().map(file_of).collect(),
        tables,
        keys,
    })
}

async fn take_table(connection: &mut PgConnection, table: &TableHead, path: &Path) -> Result<()> {
    let mut file = File::create(path).await.map_err(file_error(path))?;
    let mut rows =
        connection.copy_out_raw(&format!("COPY {} TO STDOUT", column_list(table))).await?;
    while let Some(bytes) = rows.try_next().await? {
        file.write_all(&bytes).await.map_err(file_error(path))?;
    }
    file.flush().await.map_err(file_error(path))?;
    file.sync_all().await.map_err(file_error(path))
}

pub(crate) async fn must_be_empty(url: &str) -> Result<()> {
    let mut connection = PgConnection::connect(url).await?;
    // Any table counts, also one of another program.
    let tables =
        "SELECT COUNT(*) FROM information_schema.tables WHERE table_schema = current_schema()";
    let tables: i64 = sqlx::query_scalar(tables).fetch_one(&mut connection).await?;
    connection.close().await?;
    match tables {
        0 => Ok(()),
        _ => Err(StoreError::conflict(
            "database",
            "postgres",
            "has tables already; restore the backup to an empty database",
        )),
    }
}

/// Restores schema and rows in one transaction: if it fails, the database stays empty.
pub(crate) async fn restore_database(
    folder: &Path,
    manifest: &BackupManifest,
    url: &str,
) -> Result<()> {
    let mut connection = PgConnection::connect(url).await?;
    let mut tx = connection.begin().await?;
    // The schema of the backup, not the newest one: its columns must match the files.
    migrate::postgres_up_to(manifest.schema, &mut tx).await?;
    for table in &manifest.tables {
        // The name becomes a part of the statement below; only known names are let in.
        if !TABLES.contains(&table.name.as_str()) {
            return Err(not_a_backup(folder, format!("has the unknown table `{}`", table.name)));
        }
        let path = folder.join(file_of(table));
        let file = File::open(&path).await.map_err(file_error(&path))?;
        let mut copy = tx.copy_in_raw(&format!("COPY {} FROM STDIN", column_list(table))).await?;
        copy.read_from(file).await?;
        copy.finish().await?;
    }
    tx.commit().await?;
    Ok(connection.close().await?)
}

fn file_of(table: &TableHead) -> String {
    format!("{FOLDER}/{}.copy", table.name)
}

/// `table ("column", ...)`
fn column_list(table: &TableHead) -> String {
    let columns: Vec<String> =
        table.columns.iter().map(|column| format!("\"{}\"", column.replace('"', "\"\""))).collect();
    format!("{} ({})", table.name, columns.join(", "))
}
