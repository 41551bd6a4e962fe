//! A worker: claims jobs under a lease, reports their progress, and records their end.

use std::sync::Arc;
use std::time::{Duration, Instant};

use sistership_store::{Actor, Job, JobClaim, QueueWatch, StoreError, WorkerClaim};
use tokio::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, watch};
use tokio::task::JoinHandle;
use uuid::Uuid;

use super::outcome::JobError;
use super::progress::{JobProgress, StopReason};
use super::{branch, chunk, demand, diagnosis, family_prior, refinement};
use crate::app::App;
use sistership_jobs::fleet::{BULK_JOB_KIND, PRIOR_JOB_KIND};
use sistership_jobs::request::{BRANCH_JOB_KIND, DIAGNOSIS_JOB_KIND, REFINEMENT_JOB_KIND};
use sistership_listener::StopSignal;
use sistership_web_support::trace_context::{current_trace_parent, set_remote_parent};
use tracing::Instrument as _;

/// Interval at which progress is written while it changes.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);
/// Pause after a failure of the database.
const RETRY_DELAY: Duration = Duration::from_secs(1);
/// Pause while there is no space to write, which a person has to free.
const SPACE_RETRY_DELAY: Duration = Duration::from_secs(5);

/// One of the workers of this process.
pub(crate) struct Worker {
    app: App,
    name: String,
    class: JobClass,
    stopping: StopSignal,
    queue: QueueWatch,
}

/// Jobs that a worker takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JobClass {
    /// Any job.
    Any,
    /// Small jobs only.
    Small,
}

/// Permission of a worker to run a job: together with the other workers of the process, or alone.
enum WorkerTurn<'a> {
    Shared { _held: RwLockReadGuard<'a, ()> },
    Alone { held: RwLockWriteGuard<'a, ()> },
}

impl WorkerTurn<'_> {
    fn into_shared(self) -> Self {
        match self {
            Self::Alone { held } => Self::Shared { _held: held.downgrade() },
            shared => shared,
        }
    }
}

/// Running work with its progress.
struct WatchedWork {
    work: JoinHandle<Result<(), JobError>>,
    progress: JobProgress,
    seen: watch::Receiver<(f64, String)>,
}

impl Worker {
    pub(crate) fn new(app: App, class: JobClass) -> Self {
        let name = format!("{}-{}", std::process::id(), Uuid::now_v7());
        let (stopping, queue) = (app.stop_signal(), app.store().jobs().watch_queue());
        Self { stopping, queue, app, name, class }
    }

    /// Claims and runs jobs until the server stops.
    pub(crate) async fn run(mut self) {
        let turns = Arc::clone(self.app.worker_turns());
        // Set once the queue has a job during whose earlier attempt a process ended: it is claimed
        // under the exclusive turn, so that it can take no other job down with it.
        let mut alone = false;
        while !self.stopping.is_stopping() {
            let Some(turn) = self.wait_turn(&turns, alone).await else { return };
            match self.app.store().jobs().claim_next(&self.next_claim(alone)).await {
                Ok(JobClaim::Job(job)) => {
                    // Only a job during which a process has ended before keeps the other workers
                    // waiting.
                    let turn = if job.lost_workers > 0 { turn } else { turn.into_shared() };
                    self.run_job(&job).await;
                    drop(turn);
                    alone = false;
                }
                Ok(JobClaim::Alone) => alone = true,
                Ok(JobClaim::Nothing) => {
                    drop(turn);
                    alone = false;
                    self.wait_for_work(self.app.leases().poll).await;
                }
                Err(error) => {
                    drop(turn);
                    tracing::error!(%error, "jobs could not be read from the queue");
                    self.pause_after(&error).await;
                }
            }
        }
    }

    fn next_claim(&self, alone: bool) -> WorkerClaim<'_> {
        let (lease, small) = (self.app.leases().lease, self.class == JobClass::Small);
        WorkerClaim { worker: &self.name, lease, alone, small }
    }

    /// Waits for the permission to claim a job, shared or alone; returns `None` if the server
    /// stops.
    async fn wait_turn<'a>(
        &mut self,
        turns: &'a RwLock<()>,
        alone: bool,
    ) -> Option<WorkerTurn<'a>> {
        tokio::select! {
            () = self.stopping.wait() => None,
            held = turns.write(), if alone => Some(WorkerTurn::Alone { held }),
            held = turns.read(), if !alone => Some(WorkerTurn::Shared { _held: held }),
        }
    }

    /// Waits until there is a new job, the time has passed, or the server stops.
    async fn wait_for_work(&mut self, time: Duration) {
        tokio::select! {
            () = self.queue.wait_queued() => {}
            () = tokio::time::sleep(time) => {}
            () = self.stopping.wait() => {}
        }
    }

    /// Pauses after a failure of the store, also if jobs are queued meanwhile, or until the server
    /// stops.
    async fn pause_after(&mut self, error: &StoreError) {
        let delay = if error.is_out_of_space() { SPACE_RETRY_DELAY } else { RETRY_DELAY };
        tokio::select! {
            () = tokio::time::sleep(delay) => {}
            () = self.stopping.wait() => {}
        }
    }

    /// Runs a job in a span of its own, within the trace of the request that queued it.
    async fn run_job(&mut self, job: &Job) {
        let span =
            tracing::info_span!("job", job = %job.id, kind = job.kind, attempt = job.attempt);
        set_remote_parent(&span, job.trace_parent.as_deref());
        self.run_within(job).instrument(span).await;
    }

    async fn run_within(&mut self, job: &Job) {
        tracing::info!("begun");
        let (progress, seen) = JobProgress::new();
        // The job acts in the name of the user who queued it; the audit names both.
        let actor = Actor::new(job.author.clone(), format!("job {}", job.id))
            .with_trace_parent(current_trace_parent());
        let work = run_work(self.app.clone(), job.clone(), progress.clone());
        let work = tokio::spawn(actor.run_scoped(work).in_current_span());
        let mut watched = WatchedWork { work, progress, seen };
        let ended = self.supervise(job, &mut watched).await;
        if let Err(error) = self.record_end(job, ended, watched.progress.stop_reason()).await {
            tracing::error!(%error, "the result of a job could not be written");
            self.give_back(job, error).await;
        }
    }

    /// Returns a job whose end could not be written to the queue as soon as the database can be
    /// written again: this process has not ended and must not be counted as lost.
    async fn give_back(&mut self, job: &Job, mut error: StoreError) {
        while !self.stopping.is_stopping() {
            self.pause_after(&error).await;
            let jobs = self.app.store().jobs();
            let given = match jobs.release_job(&job.id, job.fence).await {
                // The job was lost by a late heartbeat: report that this worker is alive.
                Err(StoreError::Conflict { .. } | StoreError::NotFound { .. }) => {
                    jobs.mark_alive(&job.id, job.fence).await
                }
                other => other.map(drop),
            };
            match given {
                Ok(()) => return,
                Err(again) => error = again,
            }
        }
    }

    /// Renews the lease while the work runs; returns the outcome, or `None` if the work did not
    /// stop in time.
    async fn supervise(
        &mut self,
        job: &Job,
        watched: &mut WatchedWork,
    ) -> Option<Result<(), JobError>> {
        let mut beat = Instant::now();
        // Time at which the job must be given back, once the server is stopping.
        let mut leave: Option<Instant> = None;
        loop {
            tokio::select! {
                ended = &mut watched.work => return Some(ended.unwrap_or_else(|error| Err(JobError::Failed(format!(
                    "the computation was aborted by an internal error: {error}"
                ))))),
                () = self.stopping.wait(), if leave.is_none() => leave = Some(Instant::now() + self.app.leases().drain),
                () = sleep_until(leave), if leave.is_some() => {
                    watched.progress.stop(StopReason::Leaving);
                    let ended = tokio::time::timeout(self.app.limits().stop_time, &mut watched.work).await;
                    return ended.ok().and_then(Result::ok);
                }
                () = tokio::time::sleep(PROGRESS_INTERVAL.min(self.app.leases().beat)) => {}
            }
            if watched.seen.has_changed().unwrap_or(false)
                || beat.elapsed() >= self.app.leases().beat
            {
                beat = Instant::now();
                self.renew_lease(job, watched).await;
            }
        }
    }

    async fn renew_lease(&self, job: &Job, watched: &mut WatchedWork) {
        let (fraction, message) = watched.seen.borrow_and_update().clone();
        let lease = self.app.leases().lease;
        match self.app.store().jobs().heartbeat(&job.id, job.fence, fraction, &message, lease).await
        {
            Ok(false) => {}
            Ok(true) => watched.progress.stop(StopReason::Cancelled),
            Err(StoreError::Conflict { .. } | StoreError::NotFound { .. }) => {
                watched.progress.stop(StopReason::Lost)
            }
            Err(error) => tracing::warn!(%error, "a lease could not be renewed"),
        }
    }

    /// Records the end of a job.
    async fn record_end(
        &self,
        job: &Job,
        ended: Option<Result<(), JobError>>,
        stopped: Option<StopReason>,
    ) -> Result<(), StoreError> {
        let jobs = self.app.store().jobs();
        match (ended, stopped) {
            // A job that succeeded has committed its end together with its results.
            (Some(Ok(())), _) => tracing::info!("done"),
            (_, Some(StopReason::Lost)) => {
                tracing::warn!("the job has been taken over by another worker");
                jobs.mark_alive(&job.id, job.fence).await?;
            }
            (_, Some(StopReason::Leaving)) => drop(jobs.release_job(&job.id, job.fence).await?),
            (Some(Err(JobError::Stopped)), _) => {
                drop(jobs.end_cancelled(&job.id, job.fence).await?)
            }
            (Some(Err(JobError::Failed(message))), _) => {
                tracing::warn!(%message, "failed");
                jobs.fail(&job.id, job.fence, &message).await?;
            }
            // The job is run again once the database is back.
            (Some(Err(JobError::Store(error))), _) => return Err(error),
            (None, _) => tracing::warn!("a job did not stop at the deadline"),
        }
        Ok(())
    }
}

/// Waits until a given time; returns at once without one.
async fn sleep_until(moment: Option<Instant>) {
    tokio::time::sleep_until(moment.unwrap_or_else(Instant::now).into()).await;
}

async fn run_work(app: App, job: Job, progress: JobProgress) -> Result<(), JobError> {
    let _share = demand::take_memory(&app, &job, &progress).await?;
    match job.kind.as_str() {
        REFINEMENT_JOB_KIND => refinement::run_refinement(&app, &job, progress).await,
        DIAGNOSIS_JOB_KIND => diagnosis::run_diagnosis_job(&app, &job, progress).await,
        BRANCH_JOB_KIND => branch::run_training(&app, &job, progress).await,
        BULK_JOB_KIND => chunk::run_chunk(&app, &job, progress).await,
        PRIOR_JOB_KIND => family_prior::run_learning(&app, &job, progress).await,
        other => Err(JobError::Failed(format!(
            "this server does not support jobs of the kind `{other}`"
        ))),
    }
}
