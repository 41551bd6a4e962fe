//! Functions shared by the endpoints that queue jobs.

use axum::http::StatusCode;
use serde::Serialize;
use sistership_store::{Job, NewJob};

use super::jobs::JobView;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::StoredReply;

/// Adds a job to the queue.
pub(super) async fn enqueue_job(
    app: &App,
    kind: &str,
    ship: &str,
    request: &impl Serialize,
) -> Result<Job> {
    let request = serde_json::to_string(request).map_err(Problem::internal)?;
    let new = NewJob { kind: kind.to_owned(), ship: Some(ship.to_owned()), request };
    Ok(app.store().jobs().enqueue(&new).await?)
}

/// Answer to a request whose work is a job.
pub(super) fn job_reply(job: Job) -> Result<StoredReply> {
    let id = job.id.clone();
    Ok(StoredReply::new(StatusCode::ACCEPTED, &JobView::from_job(job))?
        .with_location(&["v1", "jobs", &id]))
}
