//! Migrations of the schema, embedded in the binary and applied when a store is opened, by one
//! process at a time.

use sqlx::migrate::{MigrateError, Migration, MigrationType, Migrator};
use sqlx::{PgConnection, PgPool, SqlSafeStr as _, SqlitePool};

use crate::error::{Result, StoreError};

/// A migration: its number, its name, its text.
type MigrationSource = (i64, &'static str, &'static str);

const SQLITE: &[MigrationSource] =
    &[(1, "schema", include_str!("../../../../migrations/sqlite/0001_schema.sql"))];
const POSTGRES: &[MigrationSource] =
    &[(1, "schema", include_str!("../../../../migrations/postgres/0001_schema.sql"))];

fn build_migrator(sources: &'static [MigrationSource]) -> Migrator {
    let migration = |&(version, name, sql): &MigrationSource| {
        // The last argument: each migration runs within a transaction.
        Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
    };
    Migrator::with_migrations(sources.iter().map(migration).collect())
}

/// Migrates an SQLite database in one immediate transaction: its write lock keeps other processes
/// out, as sqlx has no other lock for SQLite.
pub(crate) async fn migrate_sqlite(pool: &SqlitePool) -> Result<()> {
    let mut tx = pool.begin_with("BEGIN IMMEDIATE").await?;
    build_migrator(SQLITE).run_direct(None, &mut *tx, false).await.map_err(migration_error)?;
    Ok(tx.commit().await?)
}

/// Migrates a PostgreSQL database under the advisory lock of sqlx.
pub(crate) async fn migrate_postgres(pool: &PgPool) -> Result<()> {
    build_migrator(POSTGRES).run(pool).await.map_err(migration_error)
}

/// Creates the schema of a migration, within a transaction of the caller: that of a backup.
pub(crate) async fn postgres_up_to(version: i64, connection: &mut PgConnection) -> Result<()> {
    build_migrator(POSTGRES)
        .run_direct(Some(version), connection, false)
        .await
        .map_err(migration_error)
}

/// Names the migration by which a store differs from this program; other errors are the database's.
fn migration_error(error: MigrateError) -> StoreError {
    let reason = match &error {
        MigrateError::VersionMissing(number) => format!("has the unknown migration {number}"),
        MigrateError::VersionMismatch(number) => format!("has a different migration {number}"),
        _ => return sqlx::Error::from(error).into(),
    };
    let message = format!(
        "{reason}: the store was made by another version of sistership; open it with that \
         version, or give an empty database"
    );
    StoreError::conflict("database", "schema", message)
}

/// Returns the number of the newest migration.
pub(crate) fn newest_version() -> i64 {
    SQLITE.iter().map(|(version, ..)| *version).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn files(dialect: &str) -> Vec<String> {
        let folder = format!("{}/../../../migrations/{dialect}", env!("CARGO_MANIFEST_DIR"));
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.unwrap().file_name().into_string().unwrap()
        };
        let mut names: Vec<_> = std::fs::read_dir(folder).unwrap().map(name).collect();
        names.sort();
        names
    }

    #[test]
    fn every_migration_file_is_embedded() {
        for (dialect, sources) in [("sqlite", SQLITE), ("postgres", POSTGRES)] {
            let embedded: Vec<_> = sources
                .iter()
                .map(|(version, name, _)| format!("{version:04}_{name}.sql"))
                .collect();
            assert_eq!(files(dialect), embedded);
        }
    }
}
