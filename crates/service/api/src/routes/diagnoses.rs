//! Requests of diagnoses.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use serde_json::Value;
use sistership_diagnosis::Settings;
use sistership_store::{Job, Trial, Version};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use super::model_ref::resolve_version;
use super::named_trials::{checked_trials, no_trials};
use super::queue::{enqueue_job, job_reply};
use super::trials::all_of_ship;
use crate::app::App;
use crate::jobs::DiagnosisJob;
use crate::problem::{Problem, Result};
use crate::rights::check_ship_role;
use crate::web::field::RequestKey;
use crate::web::payload::from_slice;
use crate::web::{DocumentBody, Id, IdempotencyKey, ModelName, StoredReply};
use sistership_auth::Role;
use sistership_jobs::condition::fitted_samples;
use sistership_jobs::schema::schema_reference;

pub(super) fn diagnosis_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(diagnose))
}

/// A diagnosis to be run.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct DiagnosisRequest {
    /// The version to diagnose: `ship` (its champion), `ship/number`, `ship/alias`.
    #[schema(inline)]
    model: ModelName,
    /// Ids of trials of the ship; by default those that the version was not fitted to, or all if
    /// there are no others.
    #[schema(inline, min_items = 1)]
    trials: Option<Vec<Id>>,
    /// Settings of the diagnosis; each has a default, and all are kept with the report.
    #[serde(default)]
    #[schema(schema_with = schema_reference::<Settings>)]
    settings: Settings,
}

/// Diagnose what effects a model lacks
///
/// The work is a job: follow the `Location`, or its `/events`. It ends in a report. If missing
/// effects are found, the model with them becomes a version of the ship's line, `candidate`, whose
/// parent is the version diagnosed.
#[utoipa::path(
    post, path = "/v1/diagnoses", tag = "diagnoses",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body = DiagnosisRequest,
    responses((status = 202, body = JobView, headers(("Location" = String))))
)]
async fn diagnose(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let request: DiagnosisRequest = payload.parse_json()?;
    key.run_once(&app, payload.bytes(), |app| async move { queue_reply(&app, request).await }).await
}

async fn queue_reply(app: &App, request: DiagnosisRequest) -> Result<StoredReply> {
    job_reply(app, queue_job(app, request).await?).await
}

async fn queue_job(app: &App, request: DiagnosisRequest) -> Result<Job> {
    enqueue_job(app, &resolve_request(app, request).await?).await
}

/// Queues a diagnosis that a page requests, from the document that the endpoint takes.
pub(super) async fn queue_from_page(app: &App, asked: &Value) -> Result<Job> {
    queue_job(app, from_slice(&serde_json::to_vec(asked).map_err(Problem::internal)?)?).await
}

/// Looks up everything that the request names, so that a wrong request is refused at once.
async fn resolve_request(app: &App, request: DiagnosisRequest) -> Result<DiagnosisJob> {
    let DiagnosisRequest { model, trials, settings } = request;
    let version = resolve_version(app.store(), "model", &model).await?;
    check_ship_role(app.store(), Role::Engineer, &version.head.model).await?;
    settings
        .check_values()
        .map_err(|(field, message)| Problem::invalid(&format!("settings.{field}"), message))?;
    let ship = version.head.model.clone();
    let trials = match trials {
        Some(ids) => {
            checked_trials(app, &ship, ids, "those that the version was not fitted to").await?
        }
        None => unseen_trials(app, &version).await?,
    };
    Ok(DiagnosisJob { ship, number: version.head.number, trials, with_earlier: false, settings })
}

/// Returns the trials of the ship that a version was not fitted to; all of them if there are no
/// others.
async fn unseen_trials(app: &App, version: &Version) -> Result<Vec<String>> {
    let all = all_of_ship(app, &version.head.model).await?;
    // Trials are compared by the hash of their samples, by which recipes name them.
    let seen = fitted_samples(app.archive(), version).await?;
    let ids = |trials: &[&Trial]| trials.iter().map(|trial| trial.id.clone()).collect::<Vec<_>>();
    let new: Vec<&Trial> = all.iter().filter(|trial| !seen.contains(&trial.sha256)).collect();
    match (all.is_empty(), new.is_empty()) {
        (true, _) => Err(no_trials(&version.head.model)),
        (false, true) => Ok(ids(&all.iter().collect::<Vec<_>>())),
        (false, false) => Ok(ids(&new)),
    }
}
