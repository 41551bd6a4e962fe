//! A database as the repositories see it: reads, and transactions that are separate or steps of a
//! unit of work.

use serde_json::Value;

use crate::arguments::{StatementArgs, check_args};
use crate::chain;
use crate::connections::{DatabaseTransaction, DatabaseWriter, ReadConnection, ReadPool};
use crate::entry::NewAuditEntry;
use crate::error::Result;
use crate::queue_signal::QueueSignal;
use crate::record::DatabaseRecord;
use crate::statements::Statement;
use crate::unit::{UnitStep, UnitTransaction};

/// Connections of one database, for reading and for writing; on SQLite a single connection writes.
#[derive(Debug, Clone)]
pub(crate) struct Database {
    pub(crate) read: ReadPool,
    pub(crate) write: DatabaseWriter,
    /// The unit of work that this handle belongs to, if it belongs to one.
    pub(crate) unit: Option<UnitTransaction>,
    /// Raised after each commit that queues jobs.
    pub(crate) queue: QueueSignal,
}

/// A transaction that may write; it is undone unless [committed](Self::commit).
pub(crate) struct AuditedTransaction {
    part: TransactionKind,
    /// Audit entries, appended at the commit.
    entries: Vec<NewAuditEntry>,
    /// True if jobs are queued by the transaction.
    queues_jobs: bool,
    queue: QueueSignal,
}

enum TransactionKind {
    /// A separate transaction.
    Alone(DatabaseTransaction),
    /// A step of a unit of work, committed together with the unit.
    Step(UnitStep),
}

impl Database {
    /// Begins a transaction, or a step of the unit of work of this handle.
    pub(crate) async fn begin(&self) -> Result<AuditedTransaction> {
        let part = match &self.unit {
            Some(unit) => TransactionKind::Step(unit.begin_step(&self.write).await?),
            None => TransactionKind::Alone(self.write.begin().await?),
        };
        let queue = self.queue.clone();
        Ok(AuditedTransaction { part, entries: Vec::new(), queues_jobs: false, queue })
    }

    /// Returns the row that a reading statement finds, if there is one; within a unit of work it
    /// sees the unit's own writes.
    pub(crate) async fn fetch_optional<T: DatabaseRecord>(
        &self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Option<T>> {
        check_args(args)?;
        // A unit that has not written yet reads from the pool, and begins no transaction.
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open_transaction().await?
        {
            return open.database_transaction()?.fetch_optional(statement, args).await;
        }
        self.read.fetch_optional(statement, args).await
    }

    /// Returns the rows that a reading statement finds; within a unit of work it sees the unit's
    /// own writes.
    pub(crate) async fn fetch_all<T: DatabaseRecord>(
        &self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        check_args(args)?;
        if let Some(unit) = &self.unit
            && let Some(mut open) = unit.open_transaction().await?
        {
            return open.database_transaction()?.fetch_all(statement, args).await;
        }
        self.read.fetch_all(statement, args).await
    }

    /// Acquires a connection for several reading statements in a row.
    pub(crate) async fn acquire_reader(&self) -> Result<ReadConnection> {
        self.read.acquire_reader().await
    }

    /// Closes all connections.
    pub(crate) async fn close(&self) {
        self.read.close().await;
        self.write.close().await;
    }
}

impl AuditedTransaction {
    fn database_transaction(&mut self) -> Result<&mut DatabaseTransaction> {
        match &mut self.part {
            TransactionKind::Alone(transaction) => Ok(transaction),
            TransactionKind::Step(step) => step.database_transaction(),
        }
    }

    /// Executes a writing statement and returns the number of rows that it changed.
    pub(crate) async fn execute(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<u64> {
        check_args(args)?;
        self.database_transaction()?.execute(statement, args).await
    }

    /// Returns the row that a statement finds or returns, if there is one.
    pub(crate) async fn fetch_optional<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Option<T>> {
        check_args(args)?;
        self.database_transaction()?.fetch_optional(statement, args).await
    }

    /// Returns the row of a statement that always returns one.
    pub(crate) async fn fetch_one<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<T> {
        check_args(args)?;
        self.database_transaction()?.fetch_one(statement, args).await
    }

    /// Returns the rows that a statement finds or returns.
    pub(crate) async fn fetch_all<T: DatabaseRecord>(
        &mut self,
        statement: Statement,
        args: StatementArgs<'_>,
    ) -> Result<Vec<T>> {
        check_args(args)?;
        self.database_transaction()?.fetch_all(statement, args).await
    }

    /// Records in the audit, at the commit, that the present author does `action` to `subject`,
    /// with the state `before` and `after`.
    pub(crate) fn record_audit_event(
        &mut self,
        at_us: i64,
        action: &'static str,
        subject: String,
        before: Option<Value>,
        after: Option<Value>,
    ) {
        self.entries.push(NewAuditEntry::new(at_us, action, subject, before, after));
    }

    /// Marks that the transaction queues jobs: the workers are woken after the commit.
    pub(crate) fn mark_queued(&mut self) {
        self.queues_jobs = true;
    }

    /// Commits the transaction; a step of a unit of work is committed with the unit.
    pub(crate) async fn commit(self) -> Result<()> {
        match self.part {
            TransactionKind::Alone(mut transaction) => {
                // The audit comes last: its row of the last entry stays locked until the commit.
                chain::append_entries(&mut transaction, self.entries).await?;
                transaction.commit().await?;
                if self.queues_jobs {
                    self.queue.raise();
                }
                Ok(())
            }
            TransactionKind::Step(step) => step.commit_step(self.entries, self.queues_jobs).await,
        }
    }
}
