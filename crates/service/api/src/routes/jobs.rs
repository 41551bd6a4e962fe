//! Jobs and their state.

use std::collections::HashMap;

use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{Job, JobFilter, JobState};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::field::{Cursor, Limit};
use crate::web::{Id, Listing, Name, PathParams, QueryParams, page};

pub(super) fn job_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list, cancel_own))
        .routes(routes!(get, cancel))
        .routes(routes!(retry))
}

/// A job.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobView {
    pub id: String,
    /// `refinement`, `diagnosis`, `branch`, `family-prior` or `bulk-refinement`.
    pub kind: String,
    pub ship: Option<String>,
    /// `queued`, `running`, `succeeded`, `failed` or `cancelled`.
    pub state: &'static str,
    /// Fraction done, 0 to 1.
    pub progress: f64,
    /// Current step.
    pub message: String,
    /// The request.
    #[schema(value_type = Object)]
    pub request: Value,
    /// Result: `model`, `version`, `sha256`, `alias` (of a diagnosis only if it found effects) and
    /// `report`; of a refinement `source`, `held_out`, `ranking`; of a diagnosis `diagnosed`,
    /// `verdict`, `effects`, `before`, `after`, `next_trial`.
    #[schema(value_type = Option<Object>)]
    pub result: Option<Value>,
    /// Reason of a failure.
    pub error: Option<String>,
    /// Number of attempts.
    pub attempt: i64,
    /// True if the job was asked to stop.
    pub cancel_requested: bool,
    /// Author of the request.
    pub author: String,
    /// Place in the queue while the job waits: 1 is the next to begin. Authors take turns; within
    /// the share of an author its ships do, and small jobs precede large ones for ten minutes.
    pub place: Option<i64>,
    pub created_us: i64,
    pub started_us: Option<i64>,
    pub finished_us: Option<i64>,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct JobQuery {
    /// Only jobs of this ship.
    #[param(inline)]
    ship: Option<Name>,
    /// Only jobs in this state.
    #[param(inline)]
    state: Option<JobStateName>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct OwnJobsQuery {
    /// Only jobs of this ship.
    #[param(inline)]
    ship: Option<Name>,
}

/// Jobs that were cancelled.
#[derive(Debug, Serialize, ToSchema)]
struct CancelledJobs {
    /// Their ids; those that ran stop at their next step.
    cancelled: Vec<String>,
}

/// State of a job.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum JobStateName {
    Queued,
    Running,
    Succeeded,
    Failed,
    Cancelled,
}

impl From<JobStateName> for JobState {
    fn from(name: JobStateName) -> Self {
        match name {
            JobStateName::Queued => Self::Queued,
            JobStateName::Running => Self::Running,
            JobStateName::Succeeded => Self::Succeeded,
            JobStateName::Failed => Self::Failed,
            JobStateName::Cancelled => Self::Cancelled,
        }
    }
}

impl JobView {
    pub(super) fn from_job(job: Job) -> Self {
        let request: Value = serde_json::from_str(&job.request).unwrap_or_default();
        let result = job.result.as_deref().and_then(|result| serde_json::from_str(result).ok());
        let state = job.state.as_str();
        let Job {
            id,
            kind,
            ship,
            progress,
            message,
            error,
            attempt,
            cancel_requested,
            created_us,
            started_us,
            finished_us,
            author,
            ..
        } = job;
        Self {
            id,
            kind,
            ship,
            state,
            progress,
            message,
            request,
            result,
            error,
            attempt,
            cancel_requested,
            author,
            place: None,
            created_us,
            started_us,
            finished_us,
        }
    }

    /// Returns the view of a job with its place in the queue.
    pub(super) async fn with_place(app: &App, job: Job) -> Result<Self> {
        let waits = job.state == JobState::Queued;
        let mut view = [Self::from_job(job)];
        if waits {
            set_places(app, &mut view).await?;
        }
        let [view] = view;
        Ok(view)
    }
}

/// Sets the places of the jobs that wait.
async fn set_places(app: &App, views: &mut [JobView]) -> Result<()> {
    if views.iter().all(|view| view.state != JobState::Queued.as_str()) {
        return Ok(());
    }
    let places = app.store().jobs().queue_places().await?;
    let places: HashMap<String, i64> =
        places.into_iter().map(|place| (place.id, place.place)).collect();
    for view in views {
        view.place = places.get(&view.id).copied();
    }
    Ok(())
}

/// List the jobs, the latest first
#[utoipa::path(get, path = "/v1/jobs", tag = "jobs", params(JobQuery),
    responses((status = 200, body = Listing<JobView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<JobQuery>,
) -> Result<Json<Listing<JobView>>> {
    let filter = JobFilter {
        ship: query.ship.map(Name::into_string),
        state: query.state.map(JobState::from),
    };
    let jobs = app
        .store()
        .jobs()
        .list(&filter, &page::parse_page(query.limit, query.after.as_ref())?)
        .await?;
    let mut listing = Listing::from_list(jobs, JobView::from_job);
    set_places(&app, &mut listing.items).await?;
    Ok(Json(listing))
}

/// Get a job
#[utoipa::path(get, path = "/v1/jobs/{id}", tag = "jobs", params(("id" = inline(Id), Path)),
    responses((status = 200, body = JobView)))]
async fn get(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<JobView>> {
    let job = app.store().jobs().get(&id).await?;
    Ok(Json(JobView::with_place(&app, job).await?))
}

/// Cancel a job; a running one stops at its next step
#[utoipa::path(delete, path = "/v1/jobs/{id}", tag = "jobs", params(("id" = inline(Id), Path)),
    responses((status = 200, body = JobView)))]
async fn cancel(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<JobView>> {
    Ok(Json(JobView::from_job(app.store().jobs().request_cancel(&id).await?)))
}

/// Cancel all of the caller's jobs that wait or run, of one ship if it is named
#[utoipa::path(delete, path = "/v1/jobs", tag = "jobs", params(OwnJobsQuery),
    responses((status = 200, body = CancelledJobs)))]
async fn cancel_own(
    State(app): State<App>,
    QueryParams(query): QueryParams<OwnJobsQuery>,
) -> Result<Json<CancelledJobs>> {
    let jobs = app.store().jobs().cancel_own(query.ship.as_deref()).await?;
    Ok(Json(CancelledJobs { cancelled: jobs.into_iter().map(|job| job.id).collect() }))
}

/// Run a job again that failed or was cancelled
#[utoipa::path(
    post, path = "/v1/jobs/{id}/retry", tag = "jobs", params(("id" = inline(Id), Path)),
    responses((status = 200, body = JobView))
)]
async fn retry(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<JobView>> {
    let job = app.store().jobs().retry(&id).await?;
    Ok(Json(JobView::with_place(&app, job).await?))
}
