//! The memory that a job takes, estimated before it begins.

use std::time::Duration;

use sistership_jobs::memory::job_bytes;
use sistership_store::{Job, StoreError};

use super::diagnosis::with_earlier;
use super::outcome::{JobError, Result, permanent_failure};
use super::progress::JobProgress;
use crate::app::App;
use sistership_jobs::budget::{MemoryShare, MemoryShortage};
use sistership_jobs::request::{
    BRANCH_JOB_KIND, BranchJob, DIAGNOSIS_JOB_KIND, DiagnosisJob, REFINEMENT_JOB_KIND,
    RefinementJob,
};

/// Interval at which a job that waits for memory checks whether it must stop.
const POLL_INTERVAL: Duration = Duration::from_millis(500);

/// Takes the memory of a job as soon as others have given it back: the job waits in its worker, and
/// smaller jobs of other workers pass it.
pub(super) async fn take_memory(
    app: &App,
    job: &Job,
    progress: &JobProgress,
) -> Result<MemoryShare> {
    let bytes = estimate_demand(app, job).await?;
    loop {
        match app.job_memory().reserve(bytes, POLL_INTERVAL).await {
            Ok(share) => return Ok(share),
            Err(never @ MemoryShortage::Never { .. }) => {
                return Err(permanent_failure(format!(
                    "{never}: use fewer or shorter trials, or raise the memory for jobs"
                )));
            }
            // The report also returns false if the job has been cancelled meanwhile.
            Err(busy) if progress.report(0.0, &format!("waiting: {busy}")) => {}
            Err(_) => return Err(JobError::Stopped),
        }
    }
}

async fn estimate_demand(app: &App, job: &Job) -> Result<u64> {
    let (law, trials) = match job.kind.as_str() {
        REFINEMENT_JOB_KIND => {
            let asked =
                serde_json::from_str::<RefinementJob>(&job.request).map_err(permanent_failure)?;
            (asked.law, asked.trials)
        }
        DIAGNOSIS_JOB_KIND => {
            let asked =
                serde_json::from_str::<DiagnosisJob>(&job.request).map_err(permanent_failure)?;
            match app.store().versions().get(&asked.ship, asked.number).await {
                Ok(version) => {
                    let whole = with_earlier(app, &asked, &version).await?;
                    (Some(version.head.law), whole.unwrap_or(asked.trials))
                }
                // The job itself says that it is missing.
                Err(StoreError::NotFound { .. }) => (None, asked.trials),
                Err(error) => return Err(error.into()),
            }
        }
        BRANCH_JOB_KIND => {
            let asked =
                serde_json::from_str::<BranchJob>(&job.request).map_err(permanent_failure)?;
            (None, asked.trials)
        }
        // These kinds read one trial after the other.
        _ => (None, Vec::new()),
    };
    let mut samples = 0;
    for id in &trials {
        samples += match app.store().trials().get(id).await {
            Ok(trial) => u64::try_from(trial.sample_rows).unwrap_or(0),
            // The job itself says that it is missing.
            Err(StoreError::NotFound { .. }) => 0,
            Err(error) => return Err(error.into()),
        };
    }
    let law = match law {
        Some(name) => app.stored_law(&name).await.ok(),
        None => None,
    };
    Ok(job_bytes(samples, law.as_deref()))
}
