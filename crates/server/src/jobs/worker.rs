//! A worker: claims jobs under a lease, tells how far they are, and ends them in one way or another.

use std::time::{Duration, Instant};

use sistership_store::{Job, StoreError};
use tokio::sync::watch;
use tokio::task::JoinHandle;
use uuid::Uuid;

use super::outcome::JobError;
use super::progress::{Progress, Stop};
use super::request::{DIAGNOSIS, REFINEMENT};
use super::{chunk, demand, diagnosis, family_prior, refinement};
use crate::app::App;
use crate::fleet::{BULK, LEARN};
use crate::stopping::Stopping;

/// How often progress is written while it changes.
const TELL: Duration = Duration::from_millis(250);
/// A pause after the database has failed.
const BREATH: Duration = Duration::from_secs(1);

/// One of the workers of this process.
pub(crate) struct Worker {
    app: App,
    name: String,
    stopping: Stopping,
}

/// The work as it runs, and what it tells.
struct Watched {
    work: JoinHandle<Result<(), JobError>>,
    progress: Progress,
    seen: watch::Receiver<(f64, String)>,
}

impl Worker {
    pub(crate) fn new(app: App) -> Self {
        let name = format!("{}-{}", std::process::id(), Uuid::now_v7());
        Self { stopping: app.stopping(), app, name }
    }

    /// Works until the server is told to stop.
    pub(crate) async fn run(mut self) {
        while !self.stopping.now() {
            match self.app.store().jobs().claim(&self.name, self.app.leases().lease).await {
                Ok(Some(job)) => self.attend(&job).await,
                Ok(None) => self.rest(self.app.leases().poll).await,
                Err(error) => {
                    tracing::error!(%error, "no job could be claimed");
                    self.rest(BREATH).await;
                }
            }
        }
    }

    /// Until there is a new job, some time has passed, or the server is told to stop.
    async fn rest(&mut self, time: Duration) {
        tokio::select! {
            () = self.app.wake().notified() => {}
            () = tokio::time::sleep(time) => {}
            () = self.stopping.wait() => {}
        }
    }

    #[tracing::instrument(skip_all, fields(job = %job.id, attempt = job.attempt))]
    async fn attend(&mut self, job: &Job) {
        tracing::info!("begun");
        let (progress, seen) = Progress::new();
        let work = tokio::spawn(work(self.app.clone(), job.clone(), progress.clone()));
        let mut watched = Watched { work, progress, seen };
        let ended = self.accompany(job, &mut watched).await;
        if let Err(error) = self.end(job, ended, watched.progress.stopped()).await {
            // Whoever claims the job when its lease has run out does it again.
            tracing::error!(%error, "the end of a job could not be written");
        }
    }

    /// Keeps the lease while the work runs; gives its outcome, or none when it did not stop in time.
    async fn accompany(&mut self, job: &Job, watched: &mut Watched) -> Option<Result<(), JobError>> {
        let mut beat = Instant::now();
        // When the job must be given back, once the server is told to stop.
        let mut leave: Option<Instant> = None;
        loop {
            tokio::select! {
                ended = &mut watched.work => return Some(ended.unwrap_or_else(|error| Err(JobError::Failed(format!("the computation broke off: {error}"))))),
                () = self.stopping.wait(), if leave.is_none() => leave = Some(Instant::now() + self.app.leases().drain),
                () = until(leave), if leave.is_some() => {
                    watched.progress.stop(Stop::Leaving);
                    let ended = tokio::time::timeout(self.app.limits().stop_time, &mut watched.work).await;
                    return ended.ok().and_then(Result::ok);
                }
                () = tokio::time::sleep(TELL.min(self.app.leases().beat)) => {}
            }
            if watched.seen.has_changed().unwrap_or(false) || beat.elapsed() >= self.app.leases().beat {
                beat = Instant::now();
                self.beat(job, watched).await;
            }
        }
    }

    async fn beat(&self, job: &Job, watched: &mut Watched) {
        let (fraction, message) = watched.seen.borrow_and_update().clone();
        let lease = self.app.leases().lease;
        match self.app.store().jobs().heartbeat(&job.id, job.fence, fraction, &message, lease).await {
            Ok(false) => {}
            Ok(true) => watched.progress.stop(Stop::Cancelled),
            Err(StoreError::Conflict { .. } | StoreError::NotFound { .. }) => watched.progress.stop(Stop::Lost),
            Err(error) => tracing::warn!(%error, "a beat was missed"),
        }
    }

    /// Writes how a job has ended.
    async fn end(&self, job: &Job, ended: Option<Result<(), JobError>>, stopped: Option<Stop>) -> Result<(), StoreError> {
        let jobs = self.app.store().jobs();
        match (ended, stopped) {
            (Some(Ok(())), _) => tracing::info!("done"),
            (_, Some(Stop::Lost)) => tracing::warn!("another worker has the job now"),
            (_, Some(Stop::Leaving)) => drop(jobs.release(&job.id, job.fence).await?),
            (Some(Err(JobError::Stopped)), _) => drop(jobs.cancelled(&job.id, job.fence).await?),
            (Some(Err(JobError::Failed(message))), _) => {
                tracing::warn!(%message, "failed");
                jobs.fail(&job.id, job.fence, &message).await?;
            }
            // The lease runs out, and the job is done again once the database is back.
            (Some(Err(JobError::Store(error))), _) => return Err(error),
            (None, _) => tracing::warn!("the work did not stop in time"),
        }
        Ok(())
    }
}

/// Waits for a moment that is known.
async fn until(moment: Option<Instant>) {
    tokio::time::sleep_until(moment.unwrap_or_else(Instant::now).into()).await;
}

async fn work(app: App, job: Job, progress: Progress) -> Result<(), JobError> {
    let _share = demand::taken(&app, &job, &progress).await?;
    match job.kind.as_str() {
        REFINEMENT => refinement::run(&app, &job, progress).await,
        DIAGNOSIS => diagnosis::run(&app, &job, progress).await,
        BULK => chunk::run(&app, &job, progress).await,
        LEARN => family_prior::run(&app, &job, progress).await,
        other => Err(JobError::Failed(format!("this server does not know jobs of the kind `{other}`"))),
    }
}
