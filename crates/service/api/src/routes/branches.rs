//! Training of learned corrections, and their weights.

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use sistership_learned::BranchSettings;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use super::model_ref::resolve_version;
use super::named_trials::{checked_trials, no_trials};
use super::queue::{enqueue_job, job_reply};
use super::trials::all_of_ship;
use crate::app::App;
use crate::jobs::BranchJob;
use crate::problem::{Problem, Result};
use crate::rights::check_ship_role;
use crate::web::field::RequestKey;
use crate::web::{
    DocumentBody, Id, IdempotencyKey, ModelName, Name, Number, PathParams, StoredReply,
};
use sistership_auth::Role;
use sistership_jobs::archive::version_document;
use sistership_jobs::schema::schema_reference;
use sistership_jobs::training::foundation_number;

pub(super) fn branch_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(train)).routes(routes!(weights))
}

/// A learned correction to be trained.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct BranchRequest {
    /// The version to correct: `ship` (its champion), `ship/number`, `ship/alias`.
    #[schema(inline)]
    model: ModelName,
    /// Ids of trials of the ship; by default all of them.
    #[schema(inline, min_items = 1)]
    trials: Option<Vec<Id>>,
    /// Kind of learner and its settings. By default every kind is evaluated, and one is selected
    /// only if it improves on held-out trials by more than its uncertainty.
    #[serde(default)]
    #[schema(schema_with = schema_reference::<BranchSettings>)]
    settings: BranchSettings,
}

/// Train a learned correction of a version
///
/// The work is a job: follow the `Location`, or its `/events`. Its result is a version of the
/// ship's line, `candidate`, whose parent is the version corrected; there is none if every kind was
/// evaluated and none was selected.
#[utoipa::path(
    post, path = "/v1/branches", tag = "branches",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body = BranchRequest,
    responses((status = 202, body = JobView, headers(("Location" = String))))
)]
async fn train(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let request: BranchRequest = payload.parse_json()?;
    key.run_once(&app, payload.bytes(), |app| async move { queue_training(&app, request).await })
        .await
}

async fn queue_training(app: &App, request: BranchRequest) -> Result<StoredReply> {
    let job = resolve_request(app, request).await?;
    job_reply(app, enqueue_job(app, &job).await?).await
}

/// Looks up everything that the request names, so that a wrong request is refused at once.
async fn resolve_request(app: &App, request: BranchRequest) -> Result<BranchJob> {
    let BranchRequest { model, trials, settings } = request;
    let version = resolve_version(app.store(), "model", &model).await?;
    // Reading the version takes a reader, training on it an engineer.
    check_ship_role(app.store(), Role::Engineer, &version.head.model).await?;
    let number = base_version(app, &version.head).await?;
    settings
        .check()
        .map_err(|(field, message)| Problem::invalid(&format!("settings.{field}"), message))?;
    let ship = version.head.model.clone();
    let trials = match trials {
        Some(ids) => checked_trials(app, &ship, ids, "all of the ship's").await?,
        None => all_of_ship(app, &ship).await?.into_iter().map(|trial| trial.id).collect(),
    };
    if trials.is_empty() {
        return Err(no_trials(&ship));
    }
    Ok(BranchJob { ship, number, trials, settings })
}

/// Returns the number of the version to correct: of a version with a learned correction, the one
/// without it that it came from.
async fn base_version(app: &App, head: &sistership_store::VersionHead) -> Result<i64> {
    let number = foundation_number(app.archive(), &head.model, head.number).await?;
    let elsewhere = || {
        let name = format!("{}/{}", head.model, head.number);
        let message = format!(
            "{name} has a learned correction that was not trained on this server; choose a \
             version without one"
        );
        Problem::invalid("model", message)
    };
    number.ok_or_else(elsewhere)
}

/// Get the weights of a version's learned correction
///
/// `sistership simulate --model m.yaml` reads them from `m.weights.json` in the folder of the
/// model.
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}/weights", tag = "branches",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path)),
    responses((status = 200, body = Object))
)]
async fn weights(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
) -> Result<Response> {
    let version = app.store().versions().get(&model, number.get()).await?;
    let missing = || {
        Problem::not_found(format!(
            "version {}/{} has no learned correction",
            &model[..],
            number.get()
        ))
    };
    let branch = version_document(&version)?.model.branch.ok_or_else(missing)?;
    let bytes = app.objects().get(&branch.weights_sha256).await?;
    Ok(([(header::CONTENT_TYPE, "application/json")], bytes).into_response())
}
