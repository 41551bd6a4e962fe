//! SQL statements: one per operation, the same for both databases where possible. Each repository
//! declares its own with [`statements!`], which also lists them, so that one test prepares every
//! statement on both databases.

/// The SQL text of an operation, for each database.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Statement {
    pub(crate) sqlite: &'static str,
    pub(crate) postgres: &'static str,
}

/// Creates a statement with one text for both databases.
pub(crate) const fn same(sql: &'static str) -> Statement {
    Statement { sqlite: sql, postgres: sql }
}

/// Creates a statement with a text for each database.
pub(crate) const fn pair(sqlite: &'static str, postgres: &'static str) -> Statement {
    Statement { sqlite, postgres }
}

/// Declares statements by name, and the list of them.
macro_rules! statements {
    ($($name:ident = $statement:expr;)*) => {
        $(const $name: $crate::statements::Statement = $statement;)*

        /// Every statement of this repository.
        #[cfg(feature = "testing")]
        pub(crate) const STATEMENTS: &[(&str, $crate::statements::Statement)] = &[$((stringify!($name), $name)),*];
    };
}
pub(crate) use statements;

#[cfg(feature = "testing")]
pub(crate) use prepare::ALL;

#[cfg(feature = "testing")]
mod prepare {
    use sqlx::{Executor as _, SqlSafeStr as _};

    use crate::connections::DatabaseWriter;
    use crate::error::{Result, StoreError};
    use crate::store::Store;
    use crate::{
        aliases, audit, bulks, chain, changes, current, diagnoses, effects, families, free_space,
        garbage, grants, idempotency, identities, integrity, jobs, keys, laws, notes, overviews,
        queue_order, reports, row_seal, seal_check, search, search_index, sessions, settings,
        ships, sign_offs, statistics, store, tags, templates, trial_conditions, trials, users,
        version, versions, webhooks, work,
    };

    pub(crate) const ALL: &[(&str, &[(&str, super::Statement)])] = &[
        // A new repository must be added here, otherwise its statements are not prepared by the
        // test.
        ("aliases", aliases::STATEMENTS),
        ("audit", audit::STATEMENTS),
        ("bulks", bulks::STATEMENTS),
        ("chain", chain::STATEMENTS),
        ("changes", changes::STATEMENTS),
        ("current", current::STATEMENTS),
        ("diagnoses", diagnoses::STATEMENTS),
        ("families", families::STATEMENTS),
        ("garbage", garbage::STATEMENTS),
        ("grants", grants::STATEMENTS),
        ("idempotency", idempotency::STATEMENTS),
        ("identities", identities::STATEMENTS),
        ("integrity", integrity::STATEMENTS),
        ("jobs", jobs::STATEMENTS),
        ("effects", effects::STATEMENTS),
        ("keys", keys::STATEMENTS),
        ("laws", laws::STATEMENTS),
        ("notes", notes::STATEMENTS),
        ("queue_order", queue_order::STATEMENTS),
        ("reports", reports::STATEMENTS),
        ("room", free_space::STATEMENTS),
        ("row_seal", row_seal::STATEMENTS),
        ("seal_check", seal_check::STATEMENTS),
        ("search", search::STATEMENTS),
        ("search_index", search_index::STATEMENTS),
        ("sessions", sessions::STATEMENTS),
        ("settings", settings::STATEMENTS),
        ("ships", ships::STATEMENTS),
        ("sign_offs", sign_offs::STATEMENTS),
        ("templates", templates::STATEMENTS),
        ("standings", overviews::STATEMENTS),
        ("statistics", statistics::STATEMENTS),
        ("store", store::STATEMENTS),
        ("tags", tags::STATEMENTS),
        ("trial_conditions", trial_conditions::STATEMENTS),
        ("trials", trials::STATEMENTS),
        ("users", users::STATEMENTS),
        ("version", version::STATEMENTS),
        ("versions", versions::STATEMENTS),
        ("webhooks", webhooks::STATEMENTS),
        ("work", work::STATEMENTS),
    ];

    impl Store {
        /// Prepares every statement of the crate on this database and returns their number.
        pub async fn prepare_every_statement(&self) -> Result<usize> {
            let mut count = 0;
            for (table, statements) in ALL {
                for (name, statement) in *statements {
                    self.prepare_statement(*statement)
                        .await
                        .map_err(|error| StoreError::conflict(table, *name, error.to_string()))?;
                    count += 1;
                }
            }
            Ok(count)
        }

        async fn prepare_statement(&self, statement: super::Statement) -> sqlx::Result<()> {
            match &self.database().write {
                DatabaseWriter::Sqlite(group) => {
                    group.pool().prepare(statement.sqlite.into_sql_str()).await.map(drop)
                }
                DatabaseWriter::Postgres(pool) => pool
                    .current_lease()
                    .pool
                    .prepare(statement.postgres.into_sql_str())
                    .await
                    .map(drop),
            }
        }
    }
}
