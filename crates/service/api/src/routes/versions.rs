//! Versions of models.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde_json::Value;
use sistership_store::{PageRequest, StoreError};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::EntityTags;
use crate::web::{Listing, Name, Number, PageQuery, PathParams, QueryParams, RequestConditions};
use sistership_jobs::verify::{self, Verification};

pub(super) fn version_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(get)).routes(routes!(bytes))
}

/// Returns the endpoint that takes as long as a refinement.
pub(super) fn verification_route() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(verify_again))
}

/// A version without its document.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct VersionHead {
    pub id: String,
    /// The line of versions, which is the ship's name.
    pub model: String,
    pub number: i64,
    /// Id of the version it was made from.
    pub parent: Option<String>,
    pub law: String,
    /// `published-source`, the method of the refinement, `diagnosis`, `branch-KIND-MODE`, or
    /// `registered`.
    pub method: String,
    /// SHA-256 of its document.
    pub sha256: String,
    /// Id of its report; only in the answer for a single version.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<String>,
    pub created_us: i64,
    /// Author, as the audit names it.
    pub author: String,
}

/// A version.
#[derive(Debug, Serialize, ToSchema)]
struct VersionDetail {
    version: VersionHead,
    /// Format, ship, recipe, model and report; its exact bytes are under `/document`.
    #[schema(value_type = Object)]
    document: Value,
}

impl VersionHead {
    pub(super) fn from_head(head: sistership_store::VersionHead) -> Self {
        let sistership_store::VersionHead {
            id,
            model,
            number,
            parent,
            law,
            method,
            sha256,
            created_us,
            author,
        } = head;
        let report = None;
        Self { id, model, number, parent, law, method, sha256, report, created_us, author }
    }

    pub(super) async fn with_report(
        app: &App,
        head: sistership_store::VersionHead,
    ) -> Result<Self> {
        let reports =
            app.store().reports().by_version(&head.id, &PageRequest::first_page(1)).await?;
        let report = reports.items.into_iter().next().map(|report| report.id);
        Ok(Self { report, ..Self::from_head(head) })
    }
}

/// List the versions of a model, the latest first
#[utoipa::path(
    get, path = "/v1/models/{model}/versions", tag = "models",
    params(("model" = inline(Name), Path), PageQuery),
    responses((status = 200, body = Listing<VersionHead>))
)]
async fn list(
    State(app): State<App>,
    PathParams(model): PathParams<Name>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<VersionHead>>> {
    check_exists(&app, &model).await?;
    let versions = app.store().versions().list(&model, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(versions, VersionHead::from_head)))
}

/// Checks that a model exists. Before its first version, that of its ship is enough.
pub(super) async fn check_exists(app: &App, model: &str) -> Result<()> {
    match app.store().versions().latest(model).await {
        // A ship without versions has an empty list, but an unknown name is an error.
        Err(StoreError::NotFound { .. }) => Ok(app.store().ships().get(model).await.map(drop)?),
        other => Ok(other.map(drop)?),
    }
}

/// Get a version with its document
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path)),
    responses((status = 200, body = VersionDetail))
)]
async fn get(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
) -> Result<Json<VersionDetail>> {
    let version = app.store().versions().get(&model, number.get()).await?;
    let document = serde_json::from_str(&version.document).map_err(Problem::internal)?;
    Ok(Json(VersionDetail {
        version: VersionHead::with_report(&app, version.head).await?,
        document,
    }))
}

/// Get the document of a version, byte for byte as it was hashed
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}/document", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path),
        ("If-None-Match" = inline(Option<EntityTags>), Header, description = "ETag of the copy that you have")),
    responses((status = 200, body = Object, headers(("ETag" = String))),
    (status = 304, description = "Your copy is current"))
)]
async fn bytes(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
    conditions: RequestConditions,
) -> Result<Response> {
    let version = app.store().versions().get(&model, number.get()).await?;
    // The document never changes, so that its hash is its ETag.
    let etag = format!("\"{}\"", version.head.sha256);
    let head =
        [(header::ETAG, etag.clone()), (header::CONTENT_TYPE, "application/json".to_owned())];
    match conditions.matches_current(&etag) {
        true => Ok((StatusCode::NOT_MODIFIED, head).into_response()),
        false => Ok((head, version.document).into_response()),
    }
}

/// Derive a version again from its recipe, and compare the bytes
#[utoipa::path(
    post, path = "/v1/models/{model}/versions/{number}/verify", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path)),
    responses((status = 200, body = Verification, description = "`identical`: true if they are the same"))
)]
async fn verify_again(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
) -> Result<Json<Verification>> {
    let number = number.get();
    // The request does the work of a job, within the memory of the jobs.
    let _share = app
        .job_memory()
        .reserve(
            verify::memory_demand(app.archive(), &model, number).await?,
            app.limits().memory_wait,
        )
        .await?;
    Ok(Json(verify::verify_version(app.archive(), &model, number).await?))
}
