//! Libraries of effects, to which recipes refer.

use axum::Json;
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::{Listing, PageQuery, PathParams, QueryParams};

pub(super) fn effect_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(get))
}

/// An entry in the list of effect libraries.
#[derive(Debug, Serialize, ToSchema)]
struct EffectLibraryHead {
    /// SHA-256 of its document, by which recipes refer to it.
    sha256: String,
    created_us: i64,
}

impl EffectLibraryHead {
    fn from_library(library: sistership_store::EffectLibrary) -> Self {
        Self { sha256: library.sha256, created_us: library.created_us }
    }
}

/// List the libraries of effects, by hash
#[utoipa::path(
    get, path = "/v1/effects", tag = "effects", params(PageQuery),
    responses((status = 200, body = Listing<EffectLibraryHead>))
)]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<EffectLibraryHead>>> {
    let libraries = app.store().effect_libraries().list(&query.requested_page()?).await?;
    Ok(Json(Listing::from_list(libraries, EffectLibraryHead::from_library)))
}

/// Get a library of effects: the YAML files of its effects in sequence, byte for byte as they were
/// hashed
#[utoipa::path(
    get, path = "/v1/effects/{sha256}", tag = "effects", params(("sha256" = String, Path)),
    responses((status = 200, content((String = "application/yaml"))))
)]
async fn get(State(app): State<App>, PathParams(sha256): PathParams<String>) -> Result<Response> {
    let library = app.store().effect_libraries().get(&sha256).await?;
    Ok(([(header::CONTENT_TYPE, "application/yaml")], library.document).into_response())
}
