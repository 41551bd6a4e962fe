//! Asking for a refinement.

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use sistership_identify::refine::Settings;
use sistership_model::version::sha256;
use sistership_store::{Job, JobFilter, MAX_LIMIT, NewJob, Page, StoreError};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use super::model_ref::resolve;
use super::trials::{all_of_ship, bounded};
use crate::app::App;
use crate::jobs::{REFINEMENT, RefinementJob, SourceChoice};
use crate::problem::{Fault, Problem, Result};
use crate::web::{Key, Payload, Reply};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(refine))
}

/// A refinement to be done.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct RefinementRequest {
    /// The ship to refine a model for.
    ship: String,
    /// `auto`, or a version to start from: `ship` (her champion), `ship/number`, `ship/alias`.
    #[serde(default = "auto")]
    source: String,
    /// Ids of the trials; all of the ship's where absent.
    trials: Option<Vec<String>>,
    /// Settings of the estimator; each has a default, and all are kept with the version.
    #[serde(default)]
    #[schema(value_type = Object)]
    settings: Settings,
}

fn auto() -> String {
    "auto".to_owned()
}

/// Refine a model against trials
///
/// The work is a job: follow the `Location`, or its `/events`. What comes of it is a version of the ship's line, champion
/// where she has none and else `candidate`, with a report.
#[utoipa::path(
    post, path = "/v1/refinements", tag = "refinements",
    params(("Idempotency-Key" = Option<String>, Header, description = "Repeat the request safely under this key")),
    request_body = RefinementRequest,
    responses((status = 202, body = JobView, headers(("Location" = String))))
)]
async fn refine(State(app): State<App>, key: Key, payload: Payload) -> Result<Response> {
    let request: RefinementRequest = payload.json()?;
    let (inner, key_sha256) = (app.clone(), key.value.as_ref().map(|key| sha256(key.as_bytes())));
    key.once(&app, payload.bytes(), async move { queued(&inner, request, key_sha256).await }).await
}

async fn queued(app: &App, request: RefinementRequest, key_sha256: Option<String>) -> Result<Reply> {
    let job = match earlier(app, &request.ship, key_sha256.as_ref()).await? {
        Some(job) => job,
        None => enqueue(app, settled(app, request, key_sha256).await?).await?,
    };
    app.wake().notify_one();
    let location = format!("/v1/jobs/{}", job.id);
    Ok(Reply::new(StatusCode::ACCEPTED, &JobView::of(job))?.at(location))
}

async fn enqueue(app: &App, job: RefinementJob) -> Result<Job> {
    let request = serde_json::to_string(&job).map_err(Problem::internal)?;
    let new = NewJob { kind: REFINEMENT.to_owned(), ship: Some(job.ship), request };
    Ok(app.store().jobs().enqueue(&new).await?)
}

/// The job that the same request has queued before its answer was lost.
async fn earlier(app: &App, ship: &str, key_sha256: Option<&String>) -> Result<Option<Job>> {
    let Some(key) = key_sha256 else { return Ok(None) };
    let filter = JobFilter { ship: Some(ship.to_owned()), state: None };
    let jobs = app.store().jobs().list(&filter, &Page::first(MAX_LIMIT)).await?;
    let asked = |job: &Job| serde_json::from_str::<RefinementJob>(&job.request).ok();
    Ok(jobs.items.into_iter().find(|job| asked(job).is_some_and(|asked| asked.key_sha256.as_ref() == Some(key))))
}

/// The request with everything looked up, so that a job that is wrong is refused at once.
async fn settled(app: &App, request: RefinementRequest, key_sha256: Option<String>) -> Result<RefinementJob> {
    let RefinementRequest { ship, source, trials, settings } = request;
    match app.store().ships().get(&ship).await {
        Err(StoreError::NotFound { .. }) => {
            return Err(Problem::invalid("ship", format!("there is no ship `{ship}`; create her with POST /v1/ships")));
        }
        other => drop(other?),
    }
    settings.check().map_err(|(field, message)| Problem::invalid(&format!("settings.{field}"), message))?;
    let trials = trial_ids(app, &ship, trials).await?;
    Ok(RefinementJob { source: choice(app, &source).await?, ship, trials, settings, key_sha256 })
}

async fn choice(app: &App, source: &str) -> Result<SourceChoice> {
    if source == "auto" {
        return Ok(SourceChoice::Auto);
    }
    let head = resolve(app.store(), "source", source).await?.head;
    Ok(SourceChoice::Version { ship: head.model, number: head.number })
}

async fn trial_ids(app: &App, ship: &str, named: Option<Vec<String>>) -> Result<Vec<String>> {
    let Some(ids) = named else {
        let all: Vec<String> = all_of_ship(app, ship).await?.into_iter().map(|trial| trial.id).collect();
        return if all.is_empty() { Err(no_trials(ship)) } else { Ok(all) };
    };
    bounded(app, ids.len())?;
    if ids.is_empty() {
        return Err(Problem::invalid("trials", "is empty; name at least one, or leave it out for all of the ship's"));
    }
    for (index, id) in ids.iter().enumerate() {
        let wrong = if ids[..index].contains(id) { Some("is named twice".to_owned()) } else { mismatch(app, ship, id).await? };
        if let Some(message) = wrong {
            let problem = Problem::new(StatusCode::UNPROCESSABLE_ENTITY, format!("trials[{index}]: `{id}` {message}"));
            return Err(problem.with(Fault::at(format!("trials[{index}]"), message)));
        }
    }
    Ok(ids)
}

/// Why a trial cannot be one of the ship's.
async fn mismatch(app: &App, ship: &str, id: &str) -> Result<Option<String>> {
    match app.store().trials().get(id).await {
        Ok(trial) if trial.ship == ship => Ok(None),
        Ok(trial) => Ok(Some(format!("is a trial of `{}`, not of `{ship}`", trial.ship))),
        Err(StoreError::NotFound { .. }) => Ok(Some(format!("is not there; GET /v1/trials?ship={ship} lists her trials"))),
        Err(error) => Err(error.into()),
    }
}

fn no_trials(ship: &str) -> Problem {
    Problem::invalid("trials", format!("the ship `{ship}` has no trials; upload some with POST /v1/trials"))
}
