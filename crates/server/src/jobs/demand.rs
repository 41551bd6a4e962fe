//! The memory that a job takes, estimated before it begins.

use std::time::Duration;

use sistership_store::{Job, StoreError};

use super::outcome::{JobError, Result, failed};
use super::progress::Progress;
use super::request::{DIAGNOSIS, DiagnosisJob, REFINEMENT, RefinementJob};
use crate::app::App;
use crate::memory::{Share, Shortage};

/// Bytes of a refinement or diagnosis for each sample of its trials: what of it is held at a time of the linearised model, its
/// columns and their products. A provisional figure, a third of what the 34 trials of the Esso Osaka took before those columns were
/// made on demand (1265 MB for 135,120 samples, low-speed law, trajectory form); to be set by a measurement of this tree.
pub(crate) const DERIVING: u64 = 3 << 10;
/// Bytes of any job beside that: simulations, bands, the report.
const EVERY: u64 = 24 << 20;
/// Bytes of a sample: time and as many as eleven channels.
const SAMPLE: u64 = 96;
/// How often a job that waits for memory looks whether it shall stop.
const LOOK: Duration = Duration::from_millis(500);

/// Bytes of a trial with so many samples.
pub(crate) fn trial_bytes(samples: i64) -> u64 {
    SAMPLE * u64::try_from(samples).unwrap_or(0)
}

/// Takes what a job needs, as soon as others have given it back: it waits in its worker, and smaller jobs of other workers pass.
pub(super) async fn taken(app: &App, job: &Job, progress: &Progress) -> Result<Share> {
    let bytes = demand(app, job).await?;
    loop {
        match app.job_memory().take(bytes, LOOK).await {
            Ok(share) => return Ok(share),
            Err(never @ Shortage::Never { .. }) => {
                return Err(failed(format!("{never}: give it fewer or shorter trials, or let jobs have more memory")));
            }
            Err(busy) if progress.tell(0.0, &format!("waiting: {busy}")) => {}
            Err(_) => return Err(JobError::Stopped),
        }
    }
}

async fn demand(app: &App, job: &Job) -> Result<u64> {
    let trials = match job.kind.as_str() {
        REFINEMENT => serde_json::from_str::<RefinementJob>(&job.request).map_err(failed)?.trials,
        DIAGNOSIS => serde_json::from_str::<DiagnosisJob>(&job.request).map_err(failed)?.trials,
        // These read one trial after the other.
        _ => Vec::new(),
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
    Ok(EVERY + DERIVING * samples)
}
