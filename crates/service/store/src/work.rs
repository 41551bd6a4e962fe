//! Jobs from the side of the workers. A worker claims a job under a lease, and each claim raises
//! the job's fencing number; a worker with an older number has lost the job and cannot change it.

use std::time::Duration;

use crate::arguments::{StatementArgs, args};
use crate::checks;
use crate::clock::duration_us;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::job::{Job, JobState, job};
use crate::jobs::{JobRepository, find_job};
use crate::queue_order::QueuePlace;
use crate::statements::{Statement, pair, same, statements};

/// Number of lost workers from which a job counts as the cause of their death, and is not restarted
/// by itself.
pub const MAX_LOST_WORKERS: i64 = 2;

statements! {
    // A job that waits, or that runs under a lease that has run out; on PostgreSQL, a row that
    // another worker has locked is skipped.
    WAITING = pair(
        job!("SELECT", "FROM jobs WHERE id = $2 AND (state = 'queued' OR (state = 'running' AND \
            lease_until_us < $1))"),
        job!("SELECT", "FROM jobs WHERE id = $2 AND (state = 'queued' OR (state = 'running' AND \
            lease_until_us < $1)) FOR UPDATE SKIP LOCKED"),
    );
    START = same(job!("UPDATE jobs SET state = 'running', attempt = attempt + 1, fence = fence + \
        1, worker = $2, lease_until_us = $3, started_us = COALESCE(started_us, $4), lost_workers = \
        $5 WHERE id = $1 RETURNING", ""));
    COUNT_LOST = same("UPDATE jobs SET lost_workers = $2 WHERE id = $1");
    // The claim that took over the job has counted a worker as lost that is alive.
    LIVES = same("UPDATE jobs SET lost_workers = lost_workers - 1 \
        WHERE id = $1 AND fence > $2 AND lost_workers > 0 AND state IN ('queued', 'running')");
    // The fence must match: a worker that has lost the job changes nothing.
    HEARTBEAT = same(job!("UPDATE jobs SET progress = $3, message = $4, lease_until_us = $5 \
        WHERE id = $1 AND fence = $2 AND state = 'running' RETURNING", ""));
    END = same(job!("UPDATE jobs SET state = $3, result = $4, error = $5, finished_us = $6, \
        lease_until_us = NULL, progress = CASE WHEN CAST($4 AS TEXT) IS NULL THEN progress ELSE \
        1.0 END WHERE id = $1 AND fence = $2 AND state = 'running' RETURNING", ""));
    // The attempt was not completed and is not counted.
    RELEASE = same(job!("UPDATE jobs SET state = 'queued', attempt = attempt - 1, lease_until_us = \
        NULL, worker = NULL WHERE id = $1 AND fence = $2 AND state = 'running' RETURNING", ""));
}

/// Request of a worker for a job.
#[derive(Debug, Clone, Copy)]
pub struct WorkerClaim<'a> {
    /// Name of the worker.
    pub worker: &'a str,
    /// Time without a heartbeat after which another worker may take the job.
    pub lease: Duration,
    /// True if the worker's process does nothing else until the job ends.
    pub alone: bool,
    /// True if the worker takes small jobs only.
    pub small: bool,
}

/// Result of a worker's request for a job.
#[derive(Debug, Clone, PartialEq)]
pub enum JobClaim {
    /// The job, which the worker holds now.
    Job(Box<Job>),
    /// There is a job during which a process has died: it must be claimed by a process that does
    /// nothing else meanwhile, so that no other job is blamed if that happens again.
    Alone,
    /// There is no job.
    Nothing,
}

/// Outcome of a job.
enum JobEnd<'a> {
    Succeeded { result: &'a str },
    Failed { error: &'a str },
    Cancelled,
}

impl JobRepository<'_> {
    /// Claims the job whose turn it is, see [`crate::queue_order`]. A job that has lost
    /// [`MAX_LOST_WORKERS`] workers ends as failed; one that was to be cancelled when its worker
    /// died is cancelled.
    pub async fn claim_next(&self, claim: &WorkerClaim<'_>) -> Result<JobClaim> {
        loop {
            // Read before the transaction, so that no request waits while the queue is put in order.
            let line = self.first_in_line(claim.small).await?;
            if line.is_empty() {
                return Ok(JobClaim::Nothing);
            }
            let mut tx = self.0.begin().await?;
            let claimed = self.claim_first(&mut tx, claim, &line).await?;
            tx.commit().await?;
            // Without a claim, other workers were faster with all of them.
            if let Some(claimed) = claimed {
                return Ok(claimed);
            }
        }
    }

    /// Claims the first of these jobs that still waits.
    async fn claim_first(
        &self,
        tx: &mut AuditedTransaction,
        claim: &WorkerClaim<'_>,
        line: &[QueuePlace],
    ) -> Result<Option<JobClaim>> {
        let now = self.0.now_us();
        for QueuePlace { id, .. } in line {
            let Some(job) = tx.fetch_optional::<Job>(WAITING, args![now_us: now, id: id]).await?
            else {
                continue;
            };
            // A running job is returned only with an expired lease: its worker counts as lost.
            let lost = job.lost_workers + i64::from(job.state == JobState::Running);
            if end_abandoned(tx, &job, lost, now).await? {
                continue;
            }
            // The job may have killed its process: it runs only where no other job could be blamed.
            if lost > 0 && !claim.alone {
                return Ok(Some(JobClaim::Alone));
            }
            let values = args![id: id, worker: claim.worker,
                lease_until_us: lease_end(now, claim.lease), started_us: now, lost_workers: lost];
            return Ok(Some(JobClaim::Job(Box::new(tx.fetch_one(START, values).await?))));
        }
        Ok(None)
    }

    /// Reports that the worker which held a job under `fence` is alive: it lost the job by a late
    /// heartbeat, not by its death.
    pub async fn mark_alive(&self, id: &str, fence: i64) -> Result<()> {
        let mut tx = self.0.begin().await?;
        tx.execute(LIVES, args![id: id, fence: fence]).await?;
        tx.commit().await
    }

    /// Reports progress (0 to 1) and prolongs the lease. Returns true if the worker is asked to
    /// stop.
    pub async fn heartbeat(
        &self,
        id: &str,
        fence: i64,
        progress: f64,
        message: &str,
        lease: Duration,
    ) -> Result<bool> {
        let until = lease_end(self.0.now_us(), lease);
        let values = args![id: id, fence: fence, progress: progress, message: message,
            lease_until_us: until];
        self.update_held(HEARTBEAT, id, fence, values).await.map(|job| job.cancel_requested)
    }

    /// Completes a job with a result, JSON. For a result with a version, see
    /// [`crate::Store::commit_refinement`].
    pub async fn complete(&self, id: &str, fence: i64, result: &str) -> Result<Job> {
        self.end_job(id, fence, JobEnd::Succeeded { result }).await
    }

    /// Ends a job as failed.
    pub async fn fail(&self, id: &str, fence: i64, error: &str) -> Result<Job> {
        self.end_job(id, fence, JobEnd::Failed { error }).await
    }

    /// Ends a job as cancelled.
    pub async fn end_cancelled(&self, id: &str, fence: i64) -> Result<Job> {
        self.end_job(id, fence, JobEnd::Cancelled).await
    }

    /// Returns a job to the queue, for a worker that is asked to stop; the attempt is not counted.
    pub async fn release_job(&self, id: &str, fence: i64) -> Result<Job> {
        self.update_held(RELEASE, id, fence, args![id: id, fence: fence]).await
    }

    /// Applies a change that only the holder of the job's fencing number may make.
    async fn update_held(
        &self,
        statement: Statement,
        id: &str,
        fence: i64,
        values: StatementArgs<'_>,
    ) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        let job = update_held_job(&mut tx, statement, id, fence, values).await?;
        tx.commit().await?;
        Ok(job)
    }

    async fn end_job(&self, id: &str, fence: i64, how: JobEnd<'_>) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        let job = end_held_job(&mut tx, id, fence, how, self.0.now_us()).await?;
        tx.commit().await?;
        Ok(job)
    }
}

/// Completes a job with its result within a transaction.
pub(crate) async fn complete_job(
    tx: &mut AuditedTransaction,
    id: &str,
    fence: i64,
    result: &str,
    now_us: i64,
) -> Result<Job> {
    end_held_job(tx, id, fence, JobEnd::Succeeded { result }, now_us).await
}

async fn end_held_job(
    tx: &mut AuditedTransaction,
    id: &str,
    fence: i64,
    how: JobEnd<'_>,
    now_us: i64,
) -> Result<Job> {
    let (state, result, error) = match how {
        JobEnd::Succeeded { result } => (JobState::Succeeded, Some(result), None),
        JobEnd::Failed { error } => (JobState::Failed, None, Some(error)),
        JobEnd::Cancelled => (JobState::Cancelled, None, None),
    };
    result.map_or(Ok(()), |result| checks::check_json("result", result))?;
    let state = state.as_str();
    let values = args![id: id, fence: fence, state: state, result: result, error: error,
        finished_us: now_us];
    update_held_job(tx, END, id, fence, values).await
}

/// Ends a job that must not be restarted; returns true if it did.
async fn end_abandoned(
    tx: &mut AuditedTransaction,
    job: &Job,
    lost: i64,
    now_us: i64,
) -> Result<bool> {
    let worker = job.worker.as_deref().unwrap_or("?");
    let message = format!(
        "the process of the job ended {} without a result (last worker `{worker}`), so that it is \
         not restarted automatically. Remove the cause, then send POST /v1/jobs/{}/retry",
        if lost == MAX_LOST_WORKERS { "twice".to_owned() } else { format!("{lost} times") },
        job.id
    );
    let how = match job.state {
        JobState::Running if job.cancel_requested => JobEnd::Cancelled,
        JobState::Running if lost >= MAX_LOST_WORKERS => JobEnd::Failed { error: &message },
        _ => return Ok(false),
    };
    // Before the end, so that the ended job shows the number of its lost workers.
    tx.execute(COUNT_LOST, args![id: &job.id, lost_workers: lost]).await?;
    end_held_job(tx, &job.id, job.fence, how, now_us).await.map(|_| true)
}

async fn update_held_job(
    tx: &mut AuditedTransaction,
    statement: Statement,
    id: &str,
    fence: i64,
    values: StatementArgs<'_>,
) -> Result<Job> {
    if let Some(job) = tx.fetch_optional(statement, values).await? {
        return Ok(job);
    }
    // No row matched: the job does not exist, or another worker holds it under a newer fence.
    let job = find_job(tx, id).await?;
    let message = format!(
        "is {} with fence {}; the lease with fence {fence} is no longer valid",
        job.state, job.fence
    );
    Err(StoreError::conflict("job", id, message))
}

fn lease_end(now_us: i64, lease: Duration) -> i64 {
    now_us.saturating_add(duration_us(lease))
}
