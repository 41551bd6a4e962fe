//! Ships, to look at.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::Ship;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::condition::Condition;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::conditions::tag;
use crate::web::{Conditions, Listing, Params, Place, page};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(get))
}

/// A ship as lists show her.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ShipHead {
    pub name: String,
    /// What people call her.
    pub title: String,
    /// Ships are compared within a category.
    pub category: String,
    /// One more with each change; her ETag.
    pub revision: i64,
    pub created_us: i64,
    pub updated_us: i64,
}

/// A ship with her document.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ShipDetail {
    pub name: String,
    /// What people call her.
    pub title: String,
    /// Ships are compared within a category.
    pub category: String,
    /// One more with each change.
    pub revision: i64,
    pub created_us: i64,
    pub updated_us: i64,
    /// Whether her champion still holds.
    pub condition: Condition,
    /// The vessel as `models/schema/vessel.schema.json` describes it.
    #[schema(value_type = Object)]
    pub document: Value,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct Query {
    /// The most items to return, 1 to 1000.
    limit: Option<i64>,
    /// `next` of the page before.
    after: Option<String>,
    /// Of this category only.
    category: Option<String>,
}

impl ShipHead {
    pub(super) fn of(ship: Ship) -> Self {
        let Ship { name, title, category, revision, created_us, updated_us, .. } = ship;
        Self { name, title, category, revision, created_us, updated_us }
    }
}

impl ShipDetail {
    pub(super) async fn of(app: &App, ship: Ship) -> Result<Self> {
        let condition = Condition::of(app, &ship.name).await?;
        let document = serde_json::from_str(&ship.document).map_err(Problem::internal)?;
        let Ship { name, title, category, revision, created_us, updated_us, .. } = ship;
        Ok(Self { name, title, category, revision, created_us, updated_us, condition, document })
    }

    /// Her revision, and what her condition comes from: either changes what is shown, the first alone what may be changed.
    pub(super) fn etag(&self) -> String {
        tag(format!("{}{}", self.revision, self.condition.tag()))
    }

    pub(super) fn answer(self) -> Response {
        ([(header::ETAG, self.etag())], Json(self)).into_response()
    }
}

/// List the ships by name
#[utoipa::path(get, path = "/v1/ships", tag = "ships", params(Query), responses((status = 200, body = Listing<ShipHead>)))]
async fn list(State(app): State<App>, Params(query): Params<Query>) -> Result<Json<Listing<ShipHead>>> {
    let page = page::page(query.limit, query.after);
    let ships = app.store().ships().list(query.category.as_deref(), &page).await?;
    Ok(Json(Listing::of(ships, ShipHead::of)))
}

/// A ship; her ETag is what a change must present
#[utoipa::path(
    get, path = "/v1/ships/{ship}", tag = "ships", params(("ship" = String, Path)),
    responses((status = 200, body = ShipDetail, headers(("ETag" = String))), (status = 304, description = "As you have her"))
)]
async fn get(State(app): State<App>, Place(name): Place<String>, conditions: Conditions) -> Result<Response> {
    let ship = ShipDetail::of(&app, app.store().ships().get(&name).await?).await?;
    let etag = ship.etag();
    match conditions.has(&etag) {
        true => Ok((StatusCode::NOT_MODIFIED, [(header::ETAG, etag)]).into_response()),
        false => Ok(ship.answer()),
    }
}
