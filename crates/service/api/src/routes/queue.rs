//! Functions shared by the endpoints that queue jobs.

use axum::http::StatusCode;
use serde::Serialize;
use sistership_identification::refine::EstimationMethod;
use sistership_store::{Job, NewJob, StoreError};

use super::jobs::JobView;
use crate::app::App;
use crate::jobs::{
    BRANCH_JOB_KIND, BranchJob, DIAGNOSIS_JOB_KIND, DiagnosisJob, REFINEMENT_JOB_KIND,
    RefinementJob, is_small,
};
use crate::problem::{Problem, Result};
use crate::web::StoredReply;

/// Number of trials above which a job is large, whatever their lengths.
const SMALL_TRIALS: usize = 64;

/// A request of a job of one ship.
pub(super) trait ShipJob: Serialize {
    /// Kind of the job.
    const KIND: &'static str;

    /// Ship that the job concerns.
    fn ship(&self) -> &str;

    /// Trials that the job reads, if their size decides whether it is small.
    fn measured_trials(&self) -> Option<&[String]>;
}

impl ShipJob for RefinementJob {
    const KIND: &'static str = REFINEMENT_JOB_KIND;

    fn ship(&self) -> &str {
        &self.ship
    }

    fn measured_trials(&self) -> Option<&[String]> {
        // A search among simulations takes minutes on any trials.
        (self.settings.method != EstimationMethod::CmaEs).then_some(&self.trials)
    }
}

impl ShipJob for DiagnosisJob {
    const KIND: &'static str = DIAGNOSIS_JOB_KIND;

    fn ship(&self) -> &str {
        &self.ship
    }

    fn measured_trials(&self) -> Option<&[String]> {
        Some(&self.trials)
    }
}

impl ShipJob for BranchJob {
    const KIND: &'static str = BRANCH_JOB_KIND;

    fn ship(&self) -> &str {
        &self.ship
    }

    fn measured_trials(&self) -> Option<&[String]> {
        None
    }
}

/// Adds a job to the queue.
///
/// # Errors
/// Returns 429 if the caller has as many jobs as a person may have.
pub(super) async fn enqueue_job<J: ShipJob>(app: &App, asked: &J) -> Result<Job> {
    let request = serde_json::to_string(asked).map_err(Problem::internal)?;
    let (kind, ship) = (J::KIND.to_owned(), Some(asked.ship().to_owned()));
    let small = is_small_job(app, asked.measured_trials()).await?;
    let new = NewJob { kind, ship, request, small };
    Ok(app.store().jobs().enqueue_within(&new, app.limits().jobs_per_person.into()).await?)
}

async fn is_small_job(app: &App, trials: Option<&[String]>) -> Result<bool> {
    let Some(trials) = trials.filter(|trials| trials.len() <= SMALL_TRIALS) else {
        return Ok(false);
    };
    let mut found = Vec::with_capacity(trials.len());
    for id in trials {
        match app.store().trials().get(id).await {
            Ok(trial) => found.push(trial),
            // The job itself reports that it is missing.
            Err(StoreError::NotFound { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(is_small(found.iter()))
}

/// Answer to a request whose work is a job.
pub(super) async fn job_reply(app: &App, job: Job) -> Result<StoredReply> {
    let id = job.id.clone();
    let view = JobView::with_place(app, job).await?;
    Ok(StoredReply::new(StatusCode::ACCEPTED, &view)?.with_location(&["v1", "jobs", &id]))
}
