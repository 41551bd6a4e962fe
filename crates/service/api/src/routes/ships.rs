//! Queries of ships.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde_json::Value;
use sistership_store::{FoundShip, Ship, StoreError};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::conditions::entity_tag;
use crate::web::field::EntityTags;
use crate::web::{Listing, Name, PathParams, QueryParams, RequestConditions};
use sistership_jobs::condition::Condition;
use sistership_jobs::derive::DeriveError;
use sistership_jobs::search;
use sistership_web_support::ship_search::{self, ShipSearchQuery};

pub(super) fn ship_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(get))
}

/// A ship in a list.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ShipHead {
    pub name: String,
    /// Display name.
    pub title: String,
    /// Ships are compared within a category.
    pub category: String,
    /// Increases by one with each change; its ETag.
    pub revision: i64,
    pub created_us: i64,
    pub updated_us: i64,
    /// The correlation with `similar_to`, otherwise the value of the first particular or metric of
    /// the query.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
}

/// A ship with its document.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ShipDetail {
    pub name: String,
    /// Display name.
    pub title: String,
    /// Ships are compared within a category.
    pub category: String,
    /// Increases by one with each change.
    pub revision: i64,
    pub created_us: i64,
    pub updated_us: i64,
    /// Health of its champion.
    pub condition: Condition,
    /// The vessel as `models/schema/vessel.json` describes it.
    #[schema(value_type = Object)]
    pub document: Value,
}

impl ShipHead {
    fn from_found(ship: FoundShip) -> Self {
        let FoundShip { name, title, category, revision, created_us, updated_us, value } = ship;
        Self { name, title, category, revision, created_us, updated_us, value }
    }
}

impl ShipDetail {
    pub(super) async fn load(app: &App, ship: Ship) -> Result<Self> {
        // The condition is derived from diagnoses and drift, and may change without the ship.
        let condition = Condition::read_current(app.store(), &ship.name).await?;
        let document = serde_json::from_str(&ship.document).map_err(Problem::internal)?;
        let Ship { name, title, category, revision, created_us, updated_us, .. } = ship;
        Ok(Self { name, title, category, revision, created_us, updated_us, condition, document })
    }

    /// Returns the tag of the revision and of the data that the condition is derived from: either
    /// changes the answer, but only the revision guards changes.
    pub(super) fn etag(&self) -> String {
        entity_tag(format!("{}{}", self.revision, self.condition.entity_tag()))
    }

    pub(super) fn etag_response(self) -> Response {
        ([(header::ETAG, self.etag())], Json(self)).into_response()
    }
}

/// Find ships: by category, tag, particulars, metrics of the champion, and similarity
///
/// In order of name; with ranges in increasing order of the first of them; with `similar_to` the
/// most similar first. Particulars and metrics follow a change of ship or champion within about a
/// second.
#[utoipa::path(get, path = "/v1/ships", tag = "ships", params(ShipSearchQuery),
    responses((status = 200, body = Listing<ShipHead>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<Vec<(String, String)>>,
) -> Result<Json<Listing<ShipHead>>> {
    let (asked, page) = ship_search::parse_query(query)?;
    let found =
        search::search_ships(app.archive(), app.catalogue().known_vectors(), &asked, &page).await;
    let ships = found.map_err(|error| match error {
        DeriveError::Store(StoreError::NotFound { kind: "ship", .. }) => {
            Problem::invalid("similar_to", error.to_string())
        }
        other => other.into(),
    })?;
    Ok(Json(Listing::from_list(ships, ShipHead::from_found)))
}

/// Get a ship; a change must present its ETag
#[utoipa::path(
    get, path = "/v1/ships/{ship}", tag = "ships", params(("ship" = inline(Name), Path),
        ("If-None-Match" = inline(Option<EntityTags>), Header, description = "ETag of the copy that you have")),
    responses((status = 200, body = ShipDetail, headers(("ETag" = String))),
    (status = 304, description = "Your copy is current"))
)]
async fn get(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    conditions: RequestConditions,
) -> Result<Response> {
    let ship = ShipDetail::load(&app, app.store().ships().get(&name).await?).await?;
    let etag = ship.etag();
    // A client that has this revision already gets no body.
    match conditions.matches_current(&etag) {
        true => Ok((StatusCode::NOT_MODIFIED, [(header::ETAG, etag)]).into_response()),
        false => Ok(ship.etag_response()),
    }
}
