//! A database as repositories see it: read, or begin to write, alone or as a step of a unit of
//! work.

use serde_json::Value;

use crate::arguments::{Args, check};
use crate::chain;
use crate::connections::{DatabaseTransaction, Pool, Reader, Writer};
use crate::entry::Entry;
use crate::error::Result;
use crate::record::Record;
use crate::statements::Statement;
use crate::unit::{Unit, UnitStep};

/// The connections of one database, to read and to write; the same ones but for SQLite, where one
/// connection writes.
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
    /// What goes into the audit with it.
    entries: Vec<Entry>,
}

enum Part {
    /// One of its own.
    Alone(DatabaseTransaction),
    /// A part of a unit of work, which is kept with the whole of it.
    Step(UnitStep),
}

impl Database {
    /// Begins to write.
    pub(crate) async fn begin(&self) -> Result<Transaction> {
        let part = match &self.unit {
            Some(unit) => Part::Step(unit.step(&self.write).await?),
            None => Part::Alone(self.write.begin().await?),
        };
        Ok(Transaction { part, entries: Vec::new() })
    }

    /// The row that a reading statement finds, if any; a unit of work sees what it has written.
    pub(crate) async fn optional<T: Record>(
        &self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        check(args)?;
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open().await?
        {
            return open.transaction()?.optional(statement, args).await;
        }
        self.read.optional(statement, args).await
    }

    /// The rows that a reading statement finds; a unit of work sees what it has written.
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

    /// A connection for several reading statements in a row.
    pub(crate) async fn reader(&self) -> Result<Reader> {
        self.read.reader().await
    }

    /// Ends all connections.
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

    /// The number of rows that a writing statement changed.
    pub(crate) async fn execute(&mut self, statement: Statement, args: Args<'_>) -> Result<u64> {
        check(args)?;
        self.transaction()?.execute(statement, args).await
    }

    /// The row that a statement finds or returns, if any.
    pub(crate) async fn optional<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Option<T>> {
        check(args)?;
        self.transaction()?.optional(statement, args).await
    }

    /// The row that a statement is sure to return.
    pub(crate) async fn one<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<T> {
        check(args)?;
        self.transaction()?.one(statement, args).await
    }

    /// The rows that a statement finds or returns.
    pub(crate) async fn all<T: Record>(
        &mut self,
        statement: Statement,
        args: Args<'_>,
    ) -> Result<Vec<T>> {
        check(args)?;
        self.transaction()?.all(statement, args).await
    }

    /// Enters into the audit, as the transaction is kept, that the present actor does this to
    /// `subject`: what was true of it before, and what is since.
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

    /// Makes it last; as a step of a unit of work, together with the whole of it.
    pub(crate) async fn commit(self) -> Result<()> {
        match self.part {
            Part::Alone(mut transaction) => {
                chain::enter(&mut transaction, self.entries).await?;
                transaction.commit().await
            }
            Part::Step(step) => step.keep(self.entries).await,
        }
    }
}
