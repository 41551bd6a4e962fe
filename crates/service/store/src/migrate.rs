//! Migrations of the schema, embedded in the binary and applied when a store is opened, by one
//! process at a time.

use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::{PgConnection, PgPool, SqlSafeStr as _, SqlitePool};

use crate::error::Result;

/// A migration: its number, its name, its text.
type MigrationSource = (i64, &'static str, &'static str);

const SQLITE: &[MigrationSource] = &[
    (1, "initial", include_str!("../../../../migrations/sqlite/0001_initial.sql")),
    (2, "diagnoses", include_str!("../../../../migrations/sqlite/0002_diagnoses.sql")),
    (3, "search", include_str!("../../../../migrations/sqlite/0003_search.sql")),
    (4, "fleets", include_str!("../../../../migrations/sqlite/0004_fleets.sql")),
    (5, "effects", include_str!("../../../../migrations/sqlite/0005_effects.sql")),
    (6, "leases", include_str!("../../../../migrations/sqlite/0006_leases.sql")),
    (7, "weights", include_str!("../../../../migrations/sqlite/0007_weights.sql")),
    (8, "standing", include_str!("../../../../migrations/sqlite/0008_standing.sql")),
    (9, "access", include_str!("../../../../migrations/sqlite/0009_access.sql")),
    (10, "webhooks", include_str!("../../../../migrations/sqlite/0010_webhooks.sql")),
    (11, "identities", include_str!("../../../../migrations/sqlite/0011_identities.sql")),
    (12, "vector_stamps", include_str!("../../../../migrations/sqlite/0012_vector_stamps.sql")),
    (13, "notes", include_str!("../../../../migrations/sqlite/0013_notes.sql")),
    (14, "weighed", include_str!("../../../../migrations/sqlite/0014_weighed.sql")),
];
const POSTGRES: &[MigrationSource] = &[
    (1, "initial", include_str!("../../../../migrations/postgres/0001_initial.sql")),
    (2, "diagnoses", include_str!("../../../../migrations/postgres/0002_diagnoses.sql")),
    (3, "search", include_str!("../../../../migrations/postgres/0003_search.sql")),
    (4, "fleets", include_str!("../../../../migrations/postgres/0004_fleets.sql")),
    (5, "effects", include_str!("../../../../migrations/postgres/0005_effects.sql")),
    (6, "leases", include_str!("../../../../migrations/postgres/0006_leases.sql")),
    (7, "weights", include_str!("../../../../migrations/postgres/0007_weights.sql")),
    (8, "standing", include_str!("../../../../migrations/postgres/0008_standing.sql")),
    (9, "access", include_str!("../../../../migrations/postgres/0009_access.sql")),
    (10, "webhooks", include_str!("../../../../migrations/postgres/0010_webhooks.sql")),
    (11, "identities", include_str!("../../../../migrations/postgres/0011_identities.sql")),
    (12, "vector_stamps", include_str!("../../../../migrations/postgres/0012_vector_stamps.sql")),
    (13, "notes", include_str!("../../../../migrations/postgres/0013_notes.sql")),
    (14, "weighed", include_str!("../../../../migrations/postgres/0014_weighed.sql")),
];

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
    build_migrator(SQLITE).run_direct(None, &mut *tx, false).await.map_err(sqlx::Error::from)?;
    Ok(tx.commit().await?)
}

/// Migrates a PostgreSQL database under the advisory lock of sqlx.
pub(crate) async fn migrate_postgres(pool: &PgPool) -> Result<()> {
    Ok(build_migrator(POSTGRES).run(pool).await.map_err(sqlx::Error::from)?)
}

/// Creates the schema of an earlier migration, within a transaction of the caller.
pub(crate) async fn postgres_up_to(version: i64, connection: &mut PgConnection) -> Result<()> {
    Ok(build_migrator(POSTGRES)
        .run_direct(Some(version), connection, false)
        .await
        .map_err(sqlx::Error::from)?)
}

/// Creates the schema of an earlier migration on SQLite, for tests of upgrades.
#[cfg(all(unix, feature = "testing"))]
pub(crate) async fn sqlite_up_to(
    version: i64,
    connection: &mut sqlx::SqliteConnection,
) -> Result<()> {
    Ok(build_migrator(SQLITE)
        .run_direct(Some(version), connection, false)
        .await
        .map_err(sqlx::Error::from)?)
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
