//! A database as the repositories see it: reads, and transactions that are separate or steps of a
//! unit of work.

use serde_json::Value;

use crate::arguments::{Args, check};
use crate::chain;
use crate::connections::{DatabaseTransaction, Pool, Reader, Writer};
use crate::entry::Entry;
use crate::error::Result;
use crate::record::Record;
use crate::statements::Statement;
use crate::unit::{Unit, UnitStep};

/// Connections of one database, for reading and for writing; on SQLite a single connection writes.
#[derive(Debug, Clone)]
pub(crate) struct Database {
    pub(crate) read: Pool,
    pub(crate) write: Writer,
    /// The unit of work that this handle belongs to, if it belongs to one.
    pub(crate) unit: Option<Unit>,
}

/// A transaction that may write; it is undone unless [committed](Self::commit).
pub(crate) struct Transaction {
    part: Part,
    /// Audit entries, appended at the commit.
    entries: Vec<Entry>,
}

enum Part {
    /// A separate transaction.
    Alone(DatabaseTransaction),
    /// A step of a unit of work, committed together with the unit.
    Step(UnitStep),
}

impl Database {
    /// Begins a transaction, or a step of the unit of work of this handle.
    pub(crate) async fn begin(&self) -> Result<Transaction> {
        let part = match &self.unit {
            Some(unit) => Part::Step(unit.step(&self.write).await?),
            None => Part::Alone(self.write.begin().await?),
        };
        Ok(Transaction { part, entries: Vec::new() })
    }

    /// Returns the row that a reading statement finds, if there is one; within a unit of work it
    /// sees the unit's own writes.
    pub(crate) async fn optional<T: Record>(
        &self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        check(args)?;
        // A unit that has not written yet reads from the pool, and begins no transaction.
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open().await?
        {
            return open.transaction()?.optional(statement, args).await;
        }
        self.read.optional(statement, args).await
    }

    /// Returns the rows that a reading statement finds; within a unit of work it sees the unit's
    /// own writes.
    pub(crate) async fn all<T: Record>(
        &self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        check(args)?;
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open().await?
        {
            return open.transaction()?.all(statement, args).await;
        }
        self.read.all(statement, args).await
    }

    /// Acquires a connection for several reading statements in a row.
    pub(crate) async fn reader(&self) -> Result<Reader> {
        self.read.reader().await
    }

    /// Closes all connections.
    pub(crate) async fn close(&self) {
        self.read.close().await;
        self.write.close().await;
    }
}

impl Transaction {
    fn transaction(&mut self) -> Result<&mut DatabaseTransaction> {
        match &mut self.part {
            Part::Alone(transaction) => Ok(transaction),
            Part::Step(step) => step.transaction(),
        }
    }

    /// Executes a writing statement and returns the number of rows that it changed.
    pub(crate) async fn execute(&mut self, statement: Statement, args: Args<'_>) -> Result<u64> {
        check(args)?;
        self.transaction()?.execute(statement, args).await
    }

    /// Returns the row that a statement finds or returns, if there is one.
    pub(crate) async fn optional<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        check(args)?;
        self.transaction()?.optional(statement, args).await
    }

    /// Returns the row of a statement that always returns one.
    pub(crate) async fn one<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<T> {
        check(args)?;
        self.transaction()?.one(statement, args).await
    }

    /// Returns the rows that a statement finds or returns.
    pub(crate) async fn all<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        check(args)?;
        self.transaction()?.all(statement, args).await
    }

    /// Records in the audit, at the commit, that the present author does `action` to `subject`,
    /// with the state `before` and `after`.
    pub(crate) fn note(
        &mut self,
        at_us: i64,
        action: &'static str,
        subject: String,
        before: Option<Value>,
        after: Option<Value>,
    ) {
        self.entries.push(Entry::new(at_us, action, subject, before, after));
    }

    /// Commits the transaction; a step of a unit of work is committed with the unit.
    pub(crate) async fn commit(self) -> Result<()> {
        match self.part {
            Part::Alone(mut transaction) => {
                // The audit comes last: its row of the last entry stays locked until the commit.
                chain::enter(&mut transaction, self.entries).await?;
                transaction.commit().await
            }
            Part::Step(step) => step.keep(self.entries).await,
        }
    }
}
