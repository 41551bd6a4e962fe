//! Jobs from the side of the requester; `work.rs` has the side of the workers.

use serde_json::{Value, json};

use crate::actor::Actor;
use crate::arguments::{StatementArgs, args};
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::job::{Job, JobCount, JobFilter, JobState, NewJob, job};
use crate::page::{ListPage, PageRequest};
use crate::queue_signal::QueueWatch;
use crate::record::RowCount;
use crate::statements::{Statement, pair, same, statements};
use crate::store::Store;

statements! {
    INSERT = same(job!("INSERT INTO jobs (id, kind, ship, request, state, progress, message, \
        attempt, fence, created_us, cancel_requested, author, small, trace_parent) VALUES ($1, $2, \
        $3, $4, 'queued', 0, '', 0, 0, $5, 0, $6, $7, $8) RETURNING", ""));
    GET = same(job!("SELECT", "FROM jobs WHERE id = $1"));
    LIST = same(job!("SELECT", "FROM jobs WHERE id < COALESCE($1, '~') ORDER BY id DESC LIMIT $2"));
    // The cast gives PostgreSQL the type of a parameter that is only compared with NULL.
    LIST_SHIP = same(job!("SELECT", "FROM jobs WHERE ship = $3 AND id < COALESCE($1, '~') \
        AND (CAST($4 AS TEXT) IS NULL OR state = $4) ORDER BY id DESC LIMIT $2"));
    LIST_STATE = same(job!("SELECT", "FROM jobs WHERE state = $3 AND id < COALESCE($1, '~') ORDER \
        BY id DESC LIMIT $2"));
    COUNTS = same("SELECT kind, state, COUNT(*) AS jobs, MIN(created_us) AS oldest_us FROM jobs \
        GROUP BY kind, state ORDER BY kind, state");
    // A queued job is cancelled at once; a running one is only marked, and its worker stops it.
    CANCEL = same(job!("UPDATE jobs SET cancel_requested = 1, \
        finished_us = CASE WHEN state = 'queued' THEN $2 ELSE finished_us END, \
        state = CASE WHEN state = 'queued' THEN 'cancelled' ELSE state END \
        WHERE id = $1 AND state IN ('queued', 'running') RETURNING", ""));
    CANCEL_ALL = same(job!("UPDATE jobs SET cancel_requested = 1, \
        finished_us = CASE WHEN state = 'queued' THEN $2 ELSE finished_us END, \
        state = CASE WHEN state = 'queued' THEN 'cancelled' ELSE state END \
        WHERE state IN ('queued', 'running') AND author = $1 \
        AND (CAST($3 AS TEXT) IS NULL OR ship = $3) RETURNING", ""));
    // The jobs of an author are counted one request after the other; on SQLite the write lock of
    // the transaction does so.
    LOCK_AUTHOR = pair("SELECT 1 AS rows WHERE $1 IS NULL",
        "SELECT 1::BIGINT AS rows FROM (SELECT pg_advisory_xact_lock(hashtextextended($1, 0))) AS held");
    PENDING = same("SELECT COUNT(*) AS rows FROM jobs WHERE state IN ('queued', 'running') \
        AND author = $1 AND ship IS NOT NULL");
    // Attempts and lost workers are reset, as for a new job; the fence stays and keeps old workers
    // out.
    RETRY = same(job!("UPDATE jobs SET state = 'queued', attempt = 0, lost_workers = 0, progress = \
        0, message = '', error = NULL, worker = NULL, finished_us = NULL, cancel_requested = 0 \
        WHERE id = $1 AND state IN ('failed', 'cancelled') RETURNING", ""));
}

/// Repository of jobs.
#[derive(Debug, Clone, Copy)]
pub struct JobRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of jobs.
    pub fn jobs(&self) -> JobRepository<'_> {
        JobRepository(self)
    }
}

impl JobRepository<'_> {
    /// Returns a watch for jobs that are queued through this store, by new requests or again. Those
    /// of other processes are found by claiming.
    pub fn watch_queue(&self) -> QueueWatch {
        self.0.database().queue.subscribe()
    }

    /// Queues a job.
    pub async fn enqueue(&self, new: &NewJob) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        let job = insert_job(self.0, &mut tx, new).await?;
        tx.commit().await?;
        Ok(job)
    }

    /// Queues a job of a ship, unless its author has `most` jobs already that wait or run.
    pub async fn enqueue_within(&self, new: &NewJob, most: i64) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        let author = Actor::current().name;
        tx.fetch_optional::<RowCount>(LOCK_AUTHOR, args![author: &author]).await?;
        let pending: RowCount = tx.fetch_one(PENDING, args![author: &author]).await?;
        if pending.rows >= most {
            return Err(StoreError::QuotaExceeded {
                message: format!(
                    "{} jobs of `{author}` wait or run, and no more than {most} may; wait until \
                     some have ended, or cancel them: DELETE /v1/jobs cancels all of yours",
                    pending.rows
                ),
            });
        }
        let job = insert_job(self.0, &mut tx, new).await?;
        tx.commit().await?;
        Ok(job)
    }

    /// Cancels the present author's jobs, of one ship if it is given; returns those that waited or
    /// ran.
    pub async fn cancel_own(&self, ship: Option<&str>) -> Result<Vec<Job>> {
        let (author, now) = (Actor::current().name, self.0.now_us());
        let mut tx = self.0.begin().await?;
        let values = args![author: &author, finished_us: now, ship: ship];
        let jobs: Vec<Job> = tx.fetch_all(CANCEL_ALL, values).await?;
        for job in &jobs {
            let after = audit_state(job);
            tx.record_audit_event(now, "job.cancel", audit_subject(&job.id), None, Some(after));
        }
        tx.commit().await?;
        Ok(jobs)
    }

    /// Returns the job of an id.
    pub async fn get(&self, id: &str) -> Result<Job> {
        let job = self.0.database().fetch_optional(GET, args![id: id]).await?;
        job.ok_or_else(|| StoreError::not_found("job", id))
    }

    /// Lists jobs, the latest first.
    pub async fn list(&self, filter: &JobFilter, page: &PageRequest) -> Result<ListPage<Job>> {
        let state = filter.state.map(JobState::as_str);
        let (database, limit) = (self.0.database(), page.fetch_limit()?);
        // Separate statements, so that each has an index of its own order.
        let jobs = match (&filter.ship, state) {
            (None, None) => {
                database.fetch_all(LIST, args![after: &page.after, limit: limit]).await?
            }
            (None, Some(state)) => {
                database
                    .fetch_all(LIST_STATE, args![after: &page.after, limit: limit, state: state])
                    .await?
            }
            (Some(ship), state) => {
                database
                    .fetch_all(
                        LIST_SHIP,
                        args![after: &page.after, limit: limit, ship: ship, state: state],
                    )
                    .await?
            }
        };
        Ok(page.build_page(jobs, |job: &Job| job.id.clone()))
    }

    /// Counts the jobs by kind and state.
    pub async fn count_by_state(&self) -> Result<Vec<JobCount>> {
        self.0.database().fetch_all(COUNTS, &[]).await
    }

    /// Cancels a job that waits, or asks the worker of a running one to stop.
    pub async fn request_cancel(&self, id: &str) -> Result<Job> {
        self.change_state(
            (CANCEL, "job.cancel"),
            id,
            args![id: id, finished_us: self.0.now_us()],
            "only a queued or running job can be cancelled",
        )
        .await
    }

    /// Puts a job that failed or was cancelled back in the queue.
    pub async fn retry(&self, id: &str) -> Result<Job> {
        self.change_state(
            (RETRY, "job.retry"),
            id,
            args![id: id],
            "only a failed or cancelled job can be retried",
        )
        .await
    }

    /// Applies a change that is allowed in some states only; `rule` says which ones in the
    /// conflict.
    async fn change_state(
        &self,
        (statement, action): (Statement, &'static str),
        id: &str,
        values: StatementArgs<'_>,
        rule: &str,
    ) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        let Some(job) = tx.fetch_optional::<Job>(statement, values).await? else {
            // No row matched: the job does not exist, or its state forbids the change.
            let state = find_job(&mut tx, id).await?.state;
            return Err(StoreError::conflict("job", id, format!("is {state}; {rule}")));
        };
        let after = audit_state(&job);
        tx.record_audit_event(self.0.now_us(), action, audit_subject(id), None, Some(after));
        if job.state == JobState::Queued {
            tx.mark_queued();
        }
        tx.commit().await?;
        Ok(job)
    }
}

/// Returns the state of a job as audit entries have it.
fn audit_state(job: &Job) -> Value {
    json!({ "state": job.state.as_str(), "cancel_requested": job.cancel_requested })
}

/// Returns the subject of audit entries about a job.
fn audit_subject(id: &str) -> String {
    format!("job:{id}")
}

/// Queues a job within a transaction.
pub(crate) async fn insert_job(
    store: &Store,
    tx: &mut AuditedTransaction,
    new: &NewJob,
) -> Result<Job> {
    checks::check_name("kind", &new.kind)?;
    checks::check_json("request", &new.request)?;
    let (id, now, actor) = (store.new_id(), store.now_us(), Actor::current());
    let values = args![id: &id, kind: &new.kind, ship: &new.ship, request: &new.request,
        created_us: now, author: &actor.name, small: i64::from(new.small),
        trace_parent: &actor.trace_parent];
    let job = tx.fetch_one(INSERT, values).await?;
    tx.mark_queued();
    let after = json!({ "kind": new.kind, "ship": new.ship });
    tx.record_audit_event(now, "job.create", audit_subject(&id), None, Some(after));
    Ok(job)
}

/// Returns a job as the transaction sees it.
pub(crate) async fn find_job(tx: &mut AuditedTransaction, id: &str) -> Result<Job> {
    let job = tx.fetch_optional(GET, args![id: id]).await?;
    job.ok_or_else(|| StoreError::not_found("job", id))
}
