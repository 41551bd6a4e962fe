//! What the endpoints that queue jobs have in common.

use axum::http::StatusCode;
use serde::Serialize;
use serde_json::Value;
use sistership_store::{Job, JobFilter, MAX_LIMIT, NewJob, Page};

use super::jobs::JobView;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::Reply;

/// The job that the same request has queued before its answer was lost.
pub(super) async fn earlier(app: &App, kind: &str, ship: &str, key_sha256: Option<&String>) -> Result<Option<Job>> {
    let Some(key) = key_sha256 else { return Ok(None) };
    let filter = JobFilter { ship: Some(ship.to_owned()), state: None };
    let jobs = app.store().jobs().list(&filter, &Page::first(MAX_LIMIT)).await?;
    Ok(jobs.items.into_iter().find(|job| job.kind == kind && key_of(job).as_ref() == Some(key)))
}

fn key_of(job: &Job) -> Option<String> {
    let request: Value = serde_json::from_str(&job.request).ok()?;
    request["key_sha256"].as_str().map(str::to_owned)
}

/// Puts a job in the queue.
pub(super) async fn enqueue(app: &App, kind: &str, ship: &str, request: &impl Serialize) -> Result<Job> {
    let request = serde_json::to_string(request).map_err(Problem::internal)?;
    let new = NewJob { kind: kind.to_owned(), ship: Some(ship.to_owned()), request };
    Ok(app.store().jobs().enqueue(&new).await?)
}

/// The answer to a request whose work goes on.
pub(super) fn accepted(app: &App, job: Job) -> Result<Reply> {
    app.wake().notify_one();
    let location = format!("/v1/jobs/{}", job.id);
    Ok(Reply::new(StatusCode::ACCEPTED, &JobView::of(job))?.at(location))
}
