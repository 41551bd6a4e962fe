//! Databases with the schema of an earlier migration, and rows that it could have had.

use std::str::FromStr as _;

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{
    AssertSqlSafe, ConnectOptions as _, Connection as _, Executor as _, PgConnection,
    SqliteConnection,
};

use super::TestDatabase;
use crate::migrate;

/// Returns the numbers of all migrations.
pub fn migration_numbers() -> Vec<i64> {
    (1..=migrate::newest_version()).collect()
}

impl TestDatabase {
    /// Migrates an empty database to the schema of a migration.
    pub async fn migrate_to(self, version: i64) -> Self {
        match self.url.starts_with("sqlite") {
            true => {
                let mut connection = self.sqlite_connection().await.expect("a connection");
                migrate::sqlite_up_to(version, &mut connection).await.expect("an earlier schema");
                connection.close().await.expect("the end of a connection");
            }
            false => {
                let mut connection = PgConnection::connect(&self.url).await.expect("a connection");
                migrate::postgres_up_to(version, &mut connection).await.expect("an earlier schema");
                connection.close().await.expect("the end of a connection");
            }
        }
        self
    }

    /// Copies the rows of another database into the tables and columns that both have, without
    /// triggers and foreign keys.
    pub async fn fill_from(&self, other: &Self) {
        match self.url.starts_with("sqlite") {
            true => self.fill_sqlite(other).await,
            false => self.fill_postgres(other).await,
        }
        .expect("rows of another database");
    }

    async fn sqlite_connection(&self) -> sqlx::Result<SqliteConnection> {
        SqliteConnectOptions::from_str(&self.url)?
            .create_if_missing(true)
            .foreign_keys(false)
            .connect()
            .await
    }

    async fn fill_sqlite(&self, other: &Self) -> sqlx::Result<()> {
        let mut connection = self.sqlite_connection().await?;
        let path = other.url.trim_start_matches("sqlite://");
        connection.execute(AssertSqlSafe(format!("ATTACH DATABASE '{path}' AS other"))).await?;
        let tables = "SELECT name FROM main.sqlite_master WHERE type = 'table' AND name NOT LIKE \
            '%sql%' AND name IN (SELECT name FROM other.sqlite_master)";
        for table in sqlx::query_scalar::<_, String>(tables).fetch_all(&mut connection).await? {
            // Columns that only one of both schemas has are skipped.
            let columns = "SELECT group_concat(name) FROM pragma_table_info($1, 'main') \
                WHERE name IN (SELECT name FROM pragma_table_info($1, 'other'))";
            let columns: String =
                sqlx::query_scalar(columns).bind(&table).fetch_one(&mut connection).await?;
            let taken = format!(
                "DELETE FROM main.{table}; INSERT INTO main.{table} ({columns}) SELECT {columns} \
                 FROM other.{table}"
            );
            connection.execute(AssertSqlSafe(taken)).await?;
        }
        connection.close().await
    }

    async fn fill_postgres(&self, other: &Self) -> sqlx::Result<()> {
        let (mut to, mut from) =
            (PgConnection::connect(&self.url).await?, PgConnection::connect(&other.url).await?);
        to.execute("SET session_replication_role = replica").await?;
        let tables = "SELECT table_name::text FROM information_schema.tables WHERE table_schema = \
            'public' AND table_name NOT LIKE '%sqlx%'";
        for table in sqlx::query_scalar::<_, String>(tables).fetch_all(&mut to).await? {
            let rows =
                AssertSqlSafe(format!("SELECT coalesce(json_agg(t), '[]')::text FROM {table} t"));
            // The other database may not have the table.
            let Ok(rows) = sqlx::query_scalar::<_, String>(rows).fetch_one(&mut from).await else {
                continue;
            };
            let taken = format!(
                "INSERT INTO {table} SELECT * FROM json_populate_recordset(NULL::{table}, $1::json)"
            );
            to.execute(AssertSqlSafe(format!("DELETE FROM {table}"))).await?;
            sqlx::query(AssertSqlSafe(taken)).bind(rows).execute(&mut to).await?;
        }
        from.close().await?;
        to.close().await
    }
}
