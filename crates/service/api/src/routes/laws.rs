//! Laws of motion.

use axum::Json;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use sistership_model::Law;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::field::RequestKey;
use crate::web::{
    DocumentBody, IdempotencyKey, Listing, Name, PageQuery, PathParams, QueryParams, StoredReply,
    accept,
};

pub(super) fn law_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list, create)).routes(routes!(get))
}

/// An entry in the list of laws.
#[derive(Debug, Serialize, ToSchema)]
struct LawHead {
    name: String,
    /// SHA-256 of its text.
    sha256: String,
    created_us: i64,
}

/// A law with its text.
#[derive(Debug, Serialize, ToSchema)]
struct LawText {
    name: String,
    /// SHA-256 of its text.
    sha256: String,
    created_us: i64,
    /// The YAML file, byte for byte.
    document: String,
}

impl LawHead {
    fn from_law(law: sistership_store::Law) -> Self {
        Self { name: law.name, sha256: law.sha256, created_us: law.created_us }
    }
}

/// List the laws
#[utoipa::path(get, path = "/v1/laws", tag = "laws", params(PageQuery),
    responses((status = 200, body = Listing<LawHead>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<LawHead>>> {
    let laws = app.store().laws().list(&query.requested_page()?).await?;
    Ok(Json(Listing::from_list(laws, LawHead::from_law)))
}

/// Add a law; it never changes afterwards
///
/// The body is the law's YAML file. Its formulas, units and symmetry are checked before it is
/// stored.
#[utoipa::path(
    post, path = "/v1/laws", tag = "laws",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body(content = String, content_type = "application/yaml"),
    responses((status = 201, body = LawHead))
)]
async fn create(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let text = payload.yaml_text()?.to_owned();
    let parse = text.clone();
    // Parsing a large law takes time, hence not on the threads that serve.
    let name = app.run_blocking(move || Law::parse("body", &parse)).await??.name;
    let work = |app: App| async move {
        let head = LawHead::from_law(app.store().laws().insert(&name, &text).await?);
        Ok(StoredReply::new(StatusCode::CREATED, &head)?.with_location(&["v1", "laws", &name]))
    };
    key.run_once(&app, payload.bytes(), work).await
}

/// Get a law, as JSON or as its YAML file
#[utoipa::path(
    get, path = "/v1/laws/{law}", tag = "laws", params(("law" = inline(Name), Path)),
    responses((status = 200,
    content((LawText = "application/json"), (String = "application/yaml"))))
)]
async fn get(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    headers: HeaderMap,
) -> Result<Response> {
    let law = app.store().laws().get(&name).await?;
    if accept::choose_media(&headers, &["application/json", "application/yaml"])?
        == "application/yaml"
    {
        return Ok((
            [(header::CONTENT_TYPE, "application/yaml"), (header::VARY, "accept")],
            law.document,
        )
            .into_response());
    }
    let sistership_store::Law { name, sha256, created_us, document } = law;
    Ok(([(header::VARY, "accept")], Json(LawText { name, sha256, created_us, document }))
        .into_response())
}
