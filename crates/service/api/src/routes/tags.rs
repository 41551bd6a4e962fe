//! Tags of ships.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::{Name, PathParams, Word};

pub(super) fn tag_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(put, remove))
}

/// List the tags of a ship, in alphabetical order, at most 100
#[utoipa::path(
    get, path = "/v1/ships/{ship}/tags", tag = "ships", params(("ship" = inline(Name), Path)),
    responses((status = 200, body = Vec<String>))
)]
async fn list(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Json<Vec<String>>> {
    app.store().ships().get(&ship).await?;
    Ok(Json(app.store().ships().list_tags(&ship).await?))
}

/// Add a tag to a ship, by which it can be found
#[utoipa::path(
    put, path = "/v1/ships/{ship}/tags/{tag}", tag = "ships",
    params(("ship" = inline(Name), Path), ("tag" = inline(Word), Path)),
    responses((status = 204, description = "The ship has it"))
)]
async fn put(
    State(app): State<App>,
    PathParams((ship, tag)): PathParams<(Name, Word)>,
) -> Result<StatusCode> {
    app.store().ships().add_tag(&ship, &tag).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Remove a tag from a ship
#[utoipa::path(
    delete, path = "/v1/ships/{ship}/tags/{tag}", tag = "ships",
    params(("ship" = inline(Name), Path), ("tag" = inline(Word), Path)),
    responses((status = 204, description = "The ship no longer has it"))
)]
async fn remove(
    State(app): State<App>,
    PathParams((ship, tag)): PathParams<(Name, Word)>,
) -> Result<StatusCode> {
    app.store().ships().remove_tag(&ship, &tag).await?;
    Ok(StatusCode::NO_CONTENT)
}
