//! The connections of the two databases behind one set of operations. Every operation is written
//! once and expanded for both by [`on!`] and [`within!`].

use std::time::Duration;

use sqlx::pool::PoolConnection;
use sqlx::{PgPool, Postgres, Sqlite, SqlitePool};

use crate::arguments::{Args, bind, check};
use crate::error::Result;
use crate::group::{TransactionPart, WriterGroup};
use crate::record::Record;
use crate::statements::Statement;

/// After this long without use, a connection is asked whether it is still there.
pub(crate) const RESTED: Duration = Duration::from_secs(5);

/// Who writes.
#[derive(Debug, Clone)]
pub(crate) enum Writer {
    Sqlite(WriterGroup),
    Postgres(PgPool),
}

/// A pool of connections.
#[derive(Debug, Clone)]
pub(crate) enum Pool {
    Sqlite(SqlitePool),
    Postgres(PgPool),
}

/// A transaction of the database; it is undone unless [committed](Self::commit).
pub(crate) enum DatabaseTransaction {
    Sqlite(TransactionPart),
    Postgres(sqlx::Transaction<'static, Postgres>),
}

/// A connection that one reader keeps while there is more to ask: giving it back costs a round
/// trip.
pub(crate) enum Reader {
    Sqlite(PoolConnection<Sqlite>),
    Postgres(PoolConnection<Postgres>),
}

/// Expands one body for both databases, with the connections and the statement's text for them.
macro_rules! on {
    ($pool:expr, $statement:expr, |$connections:ident, $sql:ident| $body:expr) => {
        match $pool {
            Pool::Sqlite($connections) => {
                let $sql = $statement.sqlite;
                $body
            }
            Pool::Postgres($connections) => {
                let $sql = $statement.postgres;
                $body
            }
        }
    };
}

/// The same with the connection that a transaction has.
macro_rules! within {
    ($transaction:expr, $statement:expr, |$connection:ident, $sql:ident| $body:expr) => {
        match $transaction {
            DatabaseTransaction::Sqlite(part) => {
                let ($connection, $sql) = (part.connection()?, $statement.sqlite);
                $body
            }
            DatabaseTransaction::Postgres(transaction) => {
                let ($connection, $sql) = (&mut **transaction, $statement.postgres);
                $body
            }
        }
    };
}

impl Pool {
    /// The row that a reading statement finds, if any.
    pub(crate) async fn optional<T: Record>(
        &self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        Ok(on!(self, statement, |pool, sql| bind!(sqlx::query_as(sql), args)
            .fetch_optional(pool)
            .await)?)
    }

    /// The rows that a reading statement finds.
    pub(crate) async fn all<T: Record>(
        &self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        Ok(on!(self, statement, |pool, sql| bind!(sqlx::query_as(sql), args)
            .fetch_all(pool)
            .await)?)
    }

    /// A connection for several reading statements in a row.
    pub(crate) async fn reader(&self) -> Result<Reader> {
        Ok(match self {
            Self::Sqlite(pool) => Reader::Sqlite(pool.acquire().await?),
            Self::Postgres(pool) => Reader::Postgres(pool.acquire().await?),
        })
    }

    /// Ends all connections.
    pub(crate) async fn close(&self) {
        match self {
            Self::Sqlite(pool) => pool.close().await,
            Self::Postgres(pool) => pool.close().await,
        }
    }
}

impl Writer {
    /// Begins to write. On SQLite the lock is taken at once, so that what is read stays true until
    /// the commit.
    pub(crate) async fn begin(&self) -> Result<DatabaseTransaction> {
        Ok(match self {
            Self::Sqlite(group) => DatabaseTransaction::Sqlite(group.begin().await?),
            Self::Postgres(pool) => DatabaseTransaction::Postgres(pool.begin().await?),
        })
    }

    /// Ends all connections.
    pub(crate) async fn close(&self) {
        match self {
            Self::Sqlite(group) => group.pool().close().await,
            Self::Postgres(pool) => pool.close().await,
        }
    }
}

impl Reader {
    /// The rows that a reading statement finds.
    pub(crate) async fn all<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        check(args)?;
        Ok(match self {
            Self::Sqlite(one) => {
                bind!(sqlx::query_as(statement.sqlite), args).fetch_all(&mut **one).await
            }
            Self::Postgres(one) => {
                bind!(sqlx::query_as(statement.postgres), args).fetch_all(&mut **one).await
            }
        }?)
    }
}

impl DatabaseTransaction {
    /// The number of rows that a writing statement changed.
    pub(crate) async fn execute(&mut self, statement: Statement, args: Args<'_>) -> Result<u64> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query(sql), args)
            .execute(to)
            .await?
            .rows_affected()))
    }

    /// The row that a statement is sure to return.
    pub(crate) async fn one<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<T> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args)
            .fetch_one(to)
            .await)?)
    }

    /// The row that a statement finds or returns, if any.
    pub(crate) async fn optional<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args)
            .fetch_optional(to)
            .await)?)
    }

    /// The rows that a statement finds or returns.
    pub(crate) async fn all<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args)
            .fetch_all(to)
            .await)?)
    }

    /// Says something about the transaction itself.
    pub(crate) async fn run(&mut self, sql: &'static str) -> Result<()> {
        match self {
            Self::Sqlite(part) => sqlx::raw_sql(sql).execute(part.connection()?).await.map(drop)?,
            Self::Postgres(tx) => sqlx::raw_sql(sql).execute(&mut **tx).await.map(drop)?,
        }
        Ok(())
    }

    /// Makes it last.
    pub(crate) async fn commit(self) -> Result<()> {
        Ok(match self {
            Self::Sqlite(tx) => tx.commit().await,
            Self::Postgres(tx) => tx.commit().await,
        }?)
    }
}
