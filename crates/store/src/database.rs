//! The two databases behind one set of operations. Every operation is written once and expanded for both by [`on!`].

use sqlx::pool::PoolConnection;
use sqlx::{PgPool, Postgres, Sqlite, SqlitePool};

use crate::arguments::{Args, bind, check};
use crate::error::Result;
use crate::group::{Group, Part};
use crate::record::Record;
use crate::statements::Statement;
use crate::unit::{Step, Unit};

/// The connections of one database, to read and to write; the same ones but for SQLite, where one connection writes.
#[derive(Debug, Clone)]
pub(crate) struct Database {
    pub(crate) read: Pool,
    pub(crate) write: Writer,
    /// The unit of work that this handle belongs to, if it belongs to one.
    pub(crate) unit: Option<Unit>,
}

/// Who writes.
#[derive(Debug, Clone)]
pub(crate) enum Writer {
    Sqlite(Group),
    Postgres(PgPool),
}

/// A pool of connections.
#[derive(Debug, Clone)]
pub(crate) enum Pool {
    Sqlite(SqlitePool),
    Postgres(PgPool),
}

/// A transaction that may write; it is undone unless [committed](Self::commit).
pub(crate) enum Transaction {
    /// One of its own.
    Own(Own),
    /// A part of a unit of work, which is kept with the whole of it.
    Step(Step),
}

/// A transaction of the database.
pub(crate) enum Own {
    Sqlite(Part),
    Postgres(sqlx::Transaction<'static, Postgres>),
}

/// A connection that one reader keeps while there is more to ask: giving it back costs a round trip.
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
            Own::Sqlite(part) => {
                let ($connection, $sql) = (part.connection()?, $statement.sqlite);
                $body
            }
            Own::Postgres(transaction) => {
                let ($connection, $sql) = (&mut **transaction, $statement.postgres);
                $body
            }
        }
    };
}

impl Database {
    /// Begins to write. On SQLite the lock is taken at once, so that what is read stays true until the commit.
    pub(crate) async fn begin(&self) -> Result<Transaction> {
        Ok(match &self.unit {
            Some(unit) => Transaction::Step(unit.step(self).await?),
            None => Transaction::Own(self.begin_own().await?),
        })
    }

    pub(crate) async fn begin_own(&self) -> Result<Own> {
        Ok(match &self.write {
            Writer::Sqlite(group) => Own::Sqlite(group.begin().await?),
            Writer::Postgres(pool) => Own::Postgres(pool.begin().await?),
        })
    }

    /// The row that a reading statement finds, if any; a unit of work sees what it has written.
    pub(crate) async fn optional<T: Record>(&self, statement: Statement, args: Args<'_>) -> Result<Option<T>> {
        check(args)?;
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open().await?
        {
            return open.own()?.optional(statement, args).await;
        }
        Ok(on!(&self.read, statement, |pool, sql| bind!(sqlx::query_as(sql), args).fetch_optional(pool).await)?)
    }

    /// The rows that a reading statement finds; a unit of work sees what it has written.
    pub(crate) async fn all<T: Record>(&self, statement: Statement, args: Args<'_>) -> Result<Vec<T>> {
        check(args)?;
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open().await?
        {
            return open.own()?.all(statement, args).await;
        }
        Ok(on!(&self.read, statement, |pool, sql| bind!(sqlx::query_as(sql), args).fetch_all(pool).await)?)
    }

    /// A connection for several reading statements in a row.
    pub(crate) async fn reader(&self) -> Result<Reader> {
        Ok(match &self.read {
            Pool::Sqlite(pool) => Reader::Sqlite(pool.acquire().await?),
            Pool::Postgres(pool) => Reader::Postgres(pool.acquire().await?),
        })
    }

    /// Ends all connections.
    pub(crate) async fn close(&self) {
        match &self.read {
            Pool::Sqlite(pool) => pool.close().await,
            Pool::Postgres(pool) => pool.close().await,
        }
        match &self.write {
            Writer::Sqlite(group) => group.pool().close().await,
            Writer::Postgres(pool) => pool.close().await,
        }
    }
}

impl Reader {
    /// The rows that a reading statement finds.
    pub(crate) async fn all<T: Record>(&mut self, statement: Statement, args: Args<'_>) -> Result<Vec<T>> {
        check(args)?;
        Ok(match self {
            Self::Sqlite(one) => bind!(sqlx::query_as(statement.sqlite), args).fetch_all(&mut **one).await,
            Self::Postgres(one) => bind!(sqlx::query_as(statement.postgres), args).fetch_all(&mut **one).await,
        }?)
    }
}

impl Transaction {
    fn own(&mut self) -> Result<&mut Own> {
        match self {
            Self::Own(own) => Ok(own),
            Self::Step(step) => step.own(),
        }
    }

    /// The number of rows that a writing statement changed.
    pub(crate) async fn execute(&mut self, statement: Statement, args: Args<'_>) -> Result<u64> {
        check(args)?;
        let own = self.own()?;
        let changed = within!(own, statement, |to, sql| bind!(sqlx::query(sql), args).execute(to).await?.rows_affected());
        Ok(changed)
    }

    /// The row that a statement finds or returns, if any.
    pub(crate) async fn optional<T: Record>(&mut self, statement: Statement, args: Args<'_>) -> Result<Option<T>> {
        check(args)?;
        self.own()?.optional(statement, args).await
    }

    /// The row that a statement is sure to return.
    pub(crate) async fn one<T: Record>(&mut self, statement: Statement, args: Args<'_>) -> Result<T> {
        check(args)?;
        let own = self.own()?;
        Ok(within!(own, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_one(to).await)?)
    }

    /// Makes it last; as a step of a unit of work, together with the whole of it.
    pub(crate) async fn commit(self) -> Result<()> {
        match self {
            Self::Own(own) => own.commit().await,
            Self::Step(step) => step.keep().await,
        }
    }
}

impl Own {
    async fn optional<T: Record>(&mut self, statement: Statement, args: Args<'_>) -> Result<Option<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_optional(to).await)?)
    }

    async fn all<T: Record>(&mut self, statement: Statement, args: Args<'_>) -> Result<Vec<T>> {
        Ok(within!(self, statement, |to, sql| bind!(sqlx::query_as(sql), args).fetch_all(to).await)?)
    }

    /// Says something about the transaction itself.
    pub(crate) async fn run(&mut self, sql: &'static str) -> Result<()> {
        match self {
            Self::Sqlite(part) => sqlx::raw_sql(sql).execute(part.connection()?).await.map(drop)?,
            Self::Postgres(tx) => sqlx::raw_sql(sql).execute(&mut **tx).await.map(drop)?,
        }
        Ok(())
    }

    pub(crate) async fn commit(self) -> Result<()> {
        Ok(match self {
            Self::Sqlite(tx) => tx.commit().await,
            Self::Postgres(tx) => tx.commit().await,
        }?)
    }
}
