//! Webhooks: who is told of what happens.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_auth::secret;
use sistership_store::{Delivery, NewWebhook, Webhook};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{Positive, Remark, WebAddress};
use crate::web::{Id, Listing, Name, Paged, Params, Payload, Place};
use sistership_jobs::condition::DRIFT_LIMIT;
use sistership_jobs::webhooks::check_url;
use sistership_web_support::reply::path;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list, create))
        .routes(routes!(get, end))
        .routes(routes!(deliveries))
        .routes(routes!(again))
}

/// A webhook, but for its secret.
#[derive(Debug, Serialize, ToSchema)]
struct WebhookView {
    id: String,
    title: String,
    url: String,
    /// The ship of which it is told; null for all.
    ship: Option<String>,
    /// What it is told.
    events: Vec<String>,
    /// How many times as much a champion leaves of new trials as of those that it was fitted on
    /// before it is told of drift.
    drift_above: f64,
    created_us: i64,
    ended_us: Option<i64>,
}

/// A webhook as it is shown once.
#[derive(Debug, Serialize, ToSchema)]
struct NewWebhookView {
    /// What deliveries are signed with: it is not shown again.
    secret: String,
    /// The rest, as it is shown later too.
    about: WebhookView,
}

/// A webhook to be.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct WebhookRequest {
    /// What it is for.
    #[schema(inline)]
    title: Remark,
    /// Where it is: https, at a public address.
    #[schema(inline)]
    url: WebAddress,
    /// The ship of which it is told; all where absent.
    #[schema(inline)]
    ship: Option<Name>,
    /// What it is told, each once.
    #[schema(min_items = 1, max_items = 3)]
    events: Vec<WebhookEvent>,
    /// How many times as much a champion leaves of new trials as of those that it was fitted on
    /// before it is told of drift; 2 where absent.
    #[schema(inline)]
    drift_above: Option<Positive>,
}

/// What a webhook may be told.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, ToSchema)]
enum WebhookEvent {
    /// The champion of a ship has moved.
    #[serde(rename = "champion.moved")]
    ChampionMoved,
    /// A diagnosis found that a version lacks something.
    #[serde(rename = "diagnosis.failed")]
    DiagnosisFailed,
    /// A champion leaves much more of new trials than of those that it was fitted on.
    #[serde(rename = "drift")]
    Drift,
}

impl WebhookEvent {
    fn as_str(self) -> &'static str {
        match self {
            Self::ChampionMoved => sistership_store::CHAMPION_MOVED,
            Self::DiagnosisFailed => sistership_store::DIAGNOSIS_FAILED,
            Self::Drift => sistership_store::DRIFT,
        }
    }
}

/// What a webhook is told.
#[derive(Debug, Serialize, ToSchema)]
struct DeliveryView {
    id: String,
    event: String,
    /// What is sent.
    #[schema(value_type = Object)]
    body: Value,
    created_us: i64,
    /// How often it was sent.
    attempts: i64,
    /// When it is sent next; null once it has arrived or was given up.
    due_us: Option<i64>,
    /// When it arrived; null where it has not.
    delivered_us: Option<i64>,
    /// What came of the last attempt.
    answer: Option<String>,
}

impl WebhookView {
    async fn of(app: &App, row: Webhook) -> Result<Self> {
        let events = app.store().webhooks().events(&row.id).await?;
        let Webhook { id, title, url, ship, drift_above, created_us, ended_us, .. } = row;
        Ok(Self { id, title, url, ship, events, drift_above, created_us, ended_us })
    }
}

impl DeliveryView {
    fn of(row: Delivery) -> Self {
        let Delivery {
            id, event, body, created_us, attempts, due_us, delivered_us, answer, ..
        } = row;
        let body = serde_json::from_str(&body).unwrap_or_default();
        Self { id, event, body, created_us, attempts, due_us, delivered_us, answer }
    }
}

/// List the webhooks by id, those that have ended too
#[utoipa::path(get, path = "/v1/webhooks", tag = "webhooks", params(Paged),
    responses((status = 200, body = Listing<WebhookView>)))]
async fn list(
    State(app): State<App>,
    Params(query): Params<Paged>,
) -> Result<Json<Listing<WebhookView>>> {
    let webhooks = app.store().webhooks().list(&query.page()?).await?;
    let mut items = Vec::new();
    for webhook in webhooks.items {
        items.push(WebhookView::of(&app, webhook).await?);
    }
    let next = webhooks.next.as_ref().and_then(crate::web::page::cursor);
    Ok(Json(Listing { items, next }))
}

/// Tell a place on the web of what happens
///
/// Each delivery is a `POST` of JSON with `Sistership-Event`, `Sistership-Delivery` (the same for
/// every attempt) and `Sistership-Signature`: `t=SECONDS,v1=HEX`, the HMAC-SHA256 of
/// `SECONDS.BODY` under the secret. It is sent until a status of 200 to 299 comes back, at least
/// once. The answer has the secret, once; so the request takes no `Idempotency-Key`.
#[utoipa::path(
    post, path = "/v1/webhooks", tag = "webhooks", request_body = WebhookRequest,
    responses((status = 201, body = NewWebhookView, headers(("Location" = String))))
)]
async fn create(State(app): State<App>, payload: Payload) -> Result<Response> {
    let WebhookRequest { title, url, ship, events, drift_above } = payload.json()?;
    check_url(&url, app.limits().webhooks_private)
        .map_err(|message| Problem::invalid("url", message))?;
    let new = NewWebhook {
        title: title.into_string(),
        url: url.into_string(),
        secret: secret().map_err(Problem::internal)?,
        ship: ship.map(Name::into_string),
        drift_above: drift_above.map_or(DRIFT_LIMIT, Positive::get),
        events: events.into_iter().map(|event| event.as_str().to_owned()).collect(),
    };
    let row = app.store().webhooks().create(&new).await?;
    let location = path(&["v1", "webhooks", &row.id]);
    let about = WebhookView::of(&app, row).await?;
    let view = NewWebhookView { secret: new.secret, about };
    let head = [(header::LOCATION, location), (header::CACHE_CONTROL, "no-store".to_owned())];
    Ok((StatusCode::CREATED, head, Json(view)).into_response())
}

/// A webhook
#[utoipa::path(get, path = "/v1/webhooks/{id}", tag = "webhooks",
    params(("id" = inline(Id), Path)), responses((status = 200, body = WebhookView)))]
async fn get(State(app): State<App>, Place(id): Place<Id>) -> Result<Json<WebhookView>> {
    let webhook = app.store().webhooks().get(&id).await?;
    Ok(Json(WebhookView::of(&app, webhook).await?))
}

/// Delete a webhook permanently
#[utoipa::path(delete, path = "/v1/webhooks/{id}", tag = "webhooks",
    params(("id" = inline(Id), Path)), responses((status = 200, body = WebhookView)))]
async fn end(State(app): State<App>, Place(id): Place<Id>) -> Result<Json<WebhookView>> {
    let webhook = app.store().webhooks().end(&id).await?;
    Ok(Json(WebhookView::of(&app, webhook).await?))
}

/// What a webhook was told and is to be told, the latest first
#[utoipa::path(
    get, path = "/v1/webhooks/{id}/deliveries", tag = "webhooks",
    params(("id" = inline(Id), Path), Paged),
    responses((status = 200, body = Listing<DeliveryView>))
)]
async fn deliveries(
    State(app): State<App>,
    Place(id): Place<Id>,
    Params(query): Params<Paged>,
) -> Result<Json<Listing<DeliveryView>>> {
    app.store().webhooks().get(&id).await?;
    let deliveries = app.store().webhooks().deliveries(&id, &query.page()?).await?;
    Ok(Json(Listing::of(deliveries, DeliveryView::of)))
}

/// Send a delivery that has not arrived once more
#[utoipa::path(
    post, path = "/v1/webhooks/{id}/deliveries/{delivery}/retry", tag = "webhooks",
    params(("id" = inline(Id), Path), ("delivery" = inline(Id), Path)),
    responses((status = 200, body = DeliveryView))
)]
async fn again(
    State(app): State<App>,
    Place((id, delivery)): Place<(Id, Id)>,
) -> Result<Json<DeliveryView>> {
    Ok(Json(DeliveryView::of(app.store().webhooks().again(&id, &delivery).await?)))
}
