//! The connections of the two databases behind one set of operations. Every operation is written
//! once for both; those within a transaction are expanded by [`within!`].

use std::time::Duration;

use sqlx::pool::PoolConnection;
use sqlx::{Postgres, Sqlite, SqlitePool};

use crate::arguments::{StatementArgs, bind, check_args};
use crate::error::Result;
use crate::group::{TransactionPart, WriterGroup};
use crate::postgres_pool::{PoolLease, PostgresPool};
use crate::record::DatabaseRecord;
use crate::statements::Statement;

/// Idle time after which a connection is pinged before use.
pub(crate) const IDLE_BEFORE_PING: Duration = Duration::from_secs(5);

/// The connections that write.
#[derive(Debug, Clone)]
pub(crate) enum DatabaseWriter {
    Sqlite(WriterGroup),
    Postgres(PostgresPool),
}

/// A pool of connections that read.
#[derive(Debug, Clone)]
pub(crate) enum ReadPool {
    Sqlite(SqlitePool),
    Postgres(PostgresPool),
}

/// A transaction of the database; it is undone unless [committed](Self::commit).
pub(crate) enum DatabaseTransaction {
    Sqlite(TransactionPart),
    Postgres(sqlx::Transaction<'static, Postgres>, PoolLease),
}

/// A connection for several reads in a row: returning it to the pool after each would cost a round
/// trip.
pub(crate) enum ReadConnection {
    Sqlite(PoolConnection<Sqlite>),
    Postgres(PoolConnection<Postgres>, PoolLease),
}

// The statement is awaited inside of the macro, as the two connections have different types; on
// PostgreSQL within the deadline of the lease.
/// Expands one body, a future, for both databases, with the connection that a transaction has and
/// the statement's text for it.
macro_rules! within {
    ($transaction:expr, $statement:expr, |$connection:ident, $sql:ident| $body:expr) => {
        match $transaction {
            DatabaseTransaction::Sqlite(part) => {
                let ($connection, $sql) = (part.connection()?, $statement.sqlite);
                $body.await?
            }
            DatabaseTransaction::Postgres(transaction, lease) => {
                let ($connection, $sql) = (&mut **transaction, $statement.postgres);
                lease.within($body).await?
            }
        }
    };
}

impl ReadPool {
    /// Returns the row that a reading statement finds, if there is one.
    pub(crate) async fn fetch_optional<T: DatabaseRecord>(
        &self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Option<T>> {
        match self {
            Self::Sqlite(pool) => {
                Ok(bind!(sqlx::query_as(statement.sqlite), args).fetch_optional(pool).await?)
            }
            Self::Postgres(pool) => {
                let (lease, query) = (pool.current_lease(), sqlx::query_as(statement.postgres));
                lease.within(bind!(query, args).fetch_optional(&lease.pool)).await
            }
        }
    }

    /// Returns the rows that a reading statement finds.
    pub(crate) async fn fetch_all<T: DatabaseRecord>(
        &self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        match self {
            Self::Sqlite(pool) => {
                Ok(bind!(sqlx::query_as(statement.sqlite), args).fetch_all(pool).await?)
            }
            Self::Postgres(pool) => {
                let (lease, query) = (pool.current_lease(), sqlx::query_as(statement.postgres));
                lease.within(bind!(query, args).fetch_all(&lease.pool)).await
            }
        }
    }

    /// Acquires a connection for several reading statements in a row.
    pub(crate) async fn acquire_reader(&self) -> Result<ReadConnection> {
        Ok(match self {
            Self::Sqlite(pool) => ReadConnection::Sqlite(pool.acquire().await?),
            Self::Postgres(pool) => {
                let lease = pool.current_lease();
                let connection = lease.within(lease.pool.acquire()).await?;
                ReadConnection::Postgres(connection, lease)
            }
        })
    }

    /// Closes all connections of the pool.
    pub(crate) async fn close(&self) {
        match self {
            Self::Sqlite(pool) => pool.close().await,
            Self::Postgres(pool) => pool.close().await,
        }
    }
}

impl DatabaseWriter {
    /// Begins a transaction. On SQLite the write lock is taken at once, so that what is read stays
    /// true until the commit.
    pub(crate) async fn begin(&self) -> Result<DatabaseTransaction> {
        Ok(match self {
            Self::Sqlite(group) => DatabaseTransaction::Sqlite(group.begin().await?),
            Self::Postgres(pool) => {
                let lease = pool.current_lease();
                let transaction = lease.within(lease.pool.begin()).await?;
                DatabaseTransaction::Postgres(transaction, lease)
            }
        })
    }

    /// Closes all connections that write.
    pub(crate) async fn close(&self) {
        match self {
            Self::Sqlite(group) => group.pool().close().await,
            Self::Postgres(pool) => pool.close().await,
        }
    }
}

impl ReadConnection {
    /// Returns the rows that a reading statement finds.
    pub(crate) async fn fetch_all<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        // A reader is used without `Database`, which checks the arguments of all other reads.
        check_args(args)?;
        match self {
            Self::Sqlite(one) => {
                Ok(bind!(sqlx::query_as(statement.sqlite), args).fetch_all(&mut **one).await?)
            }
            Self::Postgres(one, lease) => {
                let query = bind!(sqlx::query_as(statement.postgres), args);
                lease.within(query.fetch_all(&mut **one)).await
            }
        }
    }

    /// Returns the rows of a statement that may read a whole table; there is no deadline.
    pub(crate) async fn fetch_table<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        Ok(match self {
            Self::Sqlite(one) => {
                bind!(sqlx::query_as(statement.sqlite), args).fetch_all(&mut **one).await?
            }
            Self::Postgres(one, _) => {
                bind!(sqlx::query_as(statement.postgres), args).fetch_all(&mut **one).await?
            }
        })
    }
}

impl DatabaseTransaction {
    /// Executes a writing statement and returns the number of rows that it changed.
    pub(crate) async fn execute(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<u64> {
        Ok(within!(self, statement, |to, sql| async move {
            bind!(sqlx::query(sql), args).execute(to).await.map(|done| done.rows_affected())
        }))
    }

    /// Returns the row of a statement that always returns one.
    pub(crate) async fn fetch_one<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<T> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_one(to)))
    }

    /// Returns the row that a statement finds or returns, if there is one.
    pub(crate) async fn fetch_optional<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Option<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_optional(to)))
    }

    /// Returns the rows that a statement finds or returns.
    pub(crate) async fn fetch_all<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_all(to)))
    }

    /// Executes a statement about the transaction itself, such as a savepoint.
    pub(crate) async fn run(&mut self, sql: &'static str) -> Result<()> {
        match self {
            Self::Sqlite(part) => sqlx::raw_sql(sql).execute(part.connection()?).await.map(drop)?,
            Self::Postgres(tx, lease) => {
                lease.within(sqlx::raw_sql(sql).execute(&mut **tx)).await.map(drop)?;
            }
        }
        Ok(())
    }

    /// Commits the transaction.
    pub(crate) async fn commit(self) -> Result<()> {
        match self {
            Self::Sqlite(tx) => Ok(tx.commit().await?),
            Self::Postgres(tx, lease) => lease.within(tx.commit()).await,
        }
    }
}
