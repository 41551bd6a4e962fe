//! The memory that a job takes, estimated before it begins.

use std::time::Duration;

use sistership_model::Law;
use sistership_store::{Job, StoreError};

use super::outcome::{JobError, Result, failed};
use super::progress::Progress;
use super::request::{DIAGNOSIS, DiagnosisJob, REFINEMENT, RefinementJob};
use crate::app::App;
use crate::memory::{Share, Shortage};

/// Bytes of a refinement or diagnosis for each sample of its trials: the linearised model, its columns and their products, most of
/// it while learning what the trials leave open. Measured with the zoo's largest law: 944 MB above the program's own for the 135,120
/// samples of 34 trials of the Esso Osaka (`--law low-speed --method trajectory`, decision 17).
pub(crate) const DERIVING: u64 = 7 << 10;
/// Terms of that law; what is held grows with their number.
const TERMS: u64 = 189;
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
    let (law, trials) = match job.kind.as_str() {
        REFINEMENT => {
            let asked = serde_json::from_str::<RefinementJob>(&job.request).map_err(failed)?;
            (asked.law, asked.trials)
        }
        DIAGNOSIS => {
            let asked = serde_json::from_str::<DiagnosisJob>(&job.request).map_err(failed)?;
            let law = match app.store().versions().get(&asked.ship, asked.number).await {
                Ok(version) => Some(version.head.law),
                // The job itself says that it is missing.
                Err(StoreError::NotFound { .. }) => None,
                Err(error) => return Err(error.into()),
            };
            (law, asked.trials)
        }
        // These read one trial after the other.
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
    let terms = match law {
        Some(name) => app.law(&name).await.map_or(0, |law| terms(&law)),
        None => 0,
    };
    Ok(EVERY + DERIVING * samples * terms.max(TERMS) / TERMS)
}

fn terms(law: &Law) -> u64 {
    let terms: usize = law.axes.values().map(|axis| axis.terms.len()).sum();
    (terms * (1 + law.submodels.len())) as u64
}
