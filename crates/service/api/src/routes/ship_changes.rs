//! Changes of ships.

use std::collections::BTreeMap;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::Value;
use sistership_model::Vessel;
use sistership_model::vessel::VesselFile;
use sistership_store::Ship;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::described::VesselBodySchema as VesselBody;
use super::ships::ShipDetail;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{EntityTags, Remark, RequestKey};
use crate::web::{DocumentBody, IdempotencyKey, Name, PathParams, RequestConditions, StoredReply};
use sistership_jobs::particulars_change::ParticularsChange;
use sistership_jobs::publish::publish_models;
use sistership_jobs::seed::new_ship;

pub(super) fn ship_change_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(create))
        .routes(routes!(replace, delete))
        .routes(routes!(undelete))
        .routes(routes!(change_particulars))
}

/// A change of particulars.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct ParticularsRequest {
    /// Source of the new values, such as `draught survey of 28 November 2026`.
    #[schema(inline)]
    citation: Remark,
    /// New value of each particular, SI; null removes it.
    values: BTreeMap<String, Option<f64>>,
}

/// Parses and checks a vessel as JSON or YAML.
async fn parse_vessel(app: &App, payload: &DocumentBody) -> Result<Vessel> {
    if payload.is_json() {
        return Ok(Vessel::from_file("body", payload.parse_json::<VesselFile>()?)?);
    }
    let text = payload
        .yaml_text()
        .map_err(|_| payload.wrong_type("application/yaml` or `application/json"))?
        .to_owned();
    Ok(app.run_blocking(move || Vessel::parse("body", &text)).await??)
}

/// Create a ship
///
/// The body is a vessel document, YAML or JSON (`models/schema/vessel.json`). Each model that it
/// publishes becomes a version; the first becomes champion. A ship known by particulars only gets
/// its first model from a refinement.
#[utoipa::path(
    post, path = "/v1/ships", tag = "ships",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body(content((VesselBody = "application/json"), (String = "application/yaml"))),
    responses((status = 201, body = ShipDetail, headers(("ETag" = String), ("Location" = String))))
)]
async fn create(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let vessel = parse_vessel(&app, &payload).await?;
    key.run_once(&app, payload.bytes(), |app| async move { create_ship(&app, &vessel).await }).await
}

/// Stores a new ship and the models that it publishes.
pub(super) async fn store_ship(app: &App, vessel: &Vessel) -> Result<Ship> {
    let zoo = app.stored_laws().await?;
    // Models that the zoo's laws refuse must not become versions.
    zoo.check_models(vessel)?;
    let new = new_ship(vessel).map_err(Problem::internal)?;
    let ship = app.store().ships().create(&new).await?;
    publish_models(app.store(), &zoo, vessel, &ship.document).await?;
    Ok(ship)
}

async fn create_ship(app: &App, vessel: &Vessel) -> Result<StoredReply> {
    let ship = ShipDetail::load(app, store_ship(app, vessel).await?).await?;
    let reply = StoredReply::new(StatusCode::CREATED, &ship)?;
    Ok(reply.with_location(&["v1", "ships", &ship.name]).with_etag(ship.etag()))
}

/// Replace a ship's document, if it is as you last read it
#[utoipa::path(
    put, path = "/v1/ships/{ship}", tag = "ships",
    params(("ship" = inline(Name), Path),
    ("If-Match" = inline(EntityTags), Header, description = "ETag of your last request")),
    request_body(content((VesselBody = "application/json"), (String = "application/yaml"))),
    responses((status = 200, body = ShipDetail, headers(("ETag" = String))))
)]
async fn replace(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    conditions: RequestConditions,
    payload: DocumentBody,
) -> Result<Response> {
    // The revision is compared before the body is parsed, and by the store again when it writes.
    let current = app.store().ships().get(&name).await?;
    let revision = conditions.required_revision(&format!("ship `{name}`"), current.revision)?;
    let vessel = parse_vessel(&app, &payload).await?;
    if vessel.name() != &*name {
        return Err(Problem::invalid(
            "name",
            format!(
                "is `{}`, but the path names `{name}`; the name of a ship cannot be changed",
                vessel.name()
            ),
        ));
    }
    let ship = store_changed_ship(&app, &vessel, revision).await?;
    Ok(ShipDetail::load(&app, ship).await?.etag_response())
}

/// Stores the changed document of a ship that is still at a revision.
async fn store_changed_ship(app: &App, vessel: &Vessel, revision: i64) -> Result<Ship> {
    let zoo = app.stored_laws().await?;
    // The same check as for a new ship, before anything is written.
    zoo.check_models(vessel)?;
    let new = new_ship(vessel).map_err(Problem::internal)?;
    let ship = app.store().ships().update(&new, revision).await?;
    publish_models(app.store(), &zoo, vessel, &ship.document).await?;
    Ok(ship)
}

/// Stores the document of a ship whose particulars have changed since a revision.
pub(super) async fn store_particulars(app: &App, document: Value, revision: i64) -> Result<Ship> {
    let file: VesselFile = serde_json::from_value(document)
        .map_err(|error| Problem::invalid("values", error.to_string()))?;
    store_changed_ship(app, &Vessel::from_file("body", file)?, revision).await
}

/// Change particulars of a ship, if it is as you last read it
///
/// Particulars that are not named stay as they are. Versions that exist keep the particulars they
/// were made with; the next refinement takes these.
#[utoipa::path(
    put, path = "/v1/ships/{ship}/particulars", tag = "ships",
    params(("ship" = inline(Name), Path),
    ("If-Match" = inline(EntityTags), Header, description = "ETag of your last request")),
    request_body = ParticularsRequest,
    responses((status = 200, body = ShipDetail, headers(("ETag" = String))))
)]
async fn change_particulars(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    conditions: RequestConditions,
    payload: DocumentBody,
) -> Result<Response> {
    let current = app.store().ships().get(&name).await?;
    let revision = conditions.required_revision(&format!("ship `{name}`"), current.revision)?;
    let ParticularsRequest { citation, values } = payload.parse_json()?;
    let document = ParticularsChange::new(&current, values)?.into_document(&citation);
    let ship = store_particulars(&app, document, revision).await?;
    Ok(ShipDetail::load(&app, ship).await?.etag_response())
}

/// Delete a ship; its versions stay, and `undelete` restores it
#[utoipa::path(
    delete, path = "/v1/ships/{ship}", tag = "ships",
    params(("ship" = inline(Name), Path),
    ("If-Match" = inline(Option<EntityTags>), Header, description = "ETag of your last request")),
    responses((status = 204, description = "Deleted"))
)]
async fn delete(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    conditions: RequestConditions,
) -> Result<Response> {
    let current = app.store().ships().get(&name).await?;
    let revision = conditions.optional_revision(&format!("ship `{name}`"), current.revision)?;
    app.store().ships().delete(&name, revision).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

/// Restore a deleted ship
#[utoipa::path(
    post, path = "/v1/ships/{ship}/undelete", tag = "ships", params(("ship" = inline(Name), Path)),
    responses((status = 200, body = ShipDetail, headers(("ETag" = String))))
)]
async fn undelete(State(app): State<App>, PathParams(name): PathParams<Name>) -> Result<Response> {
    let ship = app.store().ships().undelete(&name).await?;
    Ok(ShipDetail::load(&app, ship).await?.etag_response())
}
