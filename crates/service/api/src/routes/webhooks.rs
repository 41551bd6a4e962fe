//! Webhooks: notification of other servers.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_auth::random_secret;
use sistership_store::{Delivery, NewWebhook, Webhook};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{Positive, ReceiverAddress, Remark};
use crate::web::{DocumentBody, Id, Listing, Name, PageQuery, PathParams, QueryParams};
use sistership_jobs::condition::DRIFT_LIMIT;
use sistership_jobs::webhooks::{NO_MAIL, Receiver, check_receiver};
use sistership_web_support::reply::encode_path;

pub(super) fn webhook_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list, create))
        .routes(routes!(get, end))
        .routes(routes!(deliveries))
        .routes(routes!(again))
}

/// A webhook without its secret.
#[derive(Debug, Serialize, ToSchema)]
struct WebhookView {
    id: String,
    title: String,
    url: String,
    /// Ship whose events are sent; null for all.
    ship: Option<String>,
    /// Events that are sent.
    events: Vec<String>,
    /// Ratio of a champion's unexplained force in new trials to that in the trials it was fitted
    /// to, above which drift is reported.
    drift_above: f64,
    created_us: i64,
    ended_us: Option<i64>,
}

/// A webhook as it is shown once.
#[derive(Debug, Serialize, ToSchema)]
struct NewWebhookView {
    /// Secret that signs the deliveries; it is not shown again.
    secret: String,
    /// The rest, as later requests show it.
    about: WebhookView,
}

/// A webhook to be created.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct WebhookRequest {
    /// Purpose.
    #[schema(inline)]
    title: Remark,
    /// URL: https, at a public address; or `mailto:` and a mail box of a public domain.
    #[schema(inline)]
    url: ReceiverAddress,
    /// Ship whose events are sent; by default all.
    #[schema(inline)]
    ship: Option<Name>,
    /// Events to send, each once.
    #[schema(min_items = 1, max_items = 3)]
    events: Vec<WebhookEvent>,
    /// Ratio of a champion's unexplained force in new trials to that in the trials it was fitted
    /// to, above which drift is reported; by default 2.
    #[schema(inline)]
    drift_above: Option<Positive>,
}

/// Event of which webhooks are notified.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, ToSchema)]
enum WebhookEvent {
    /// The champion of a ship has moved.
    #[serde(rename = "champion.moved")]
    ChampionMoved,
    /// A diagnosis found that a version lacks an effect.
    #[serde(rename = "diagnosis.failed")]
    DiagnosisFailed,
    /// A champion leaves much more force unexplained in new trials than in those it was fitted to.
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

/// A delivery to a webhook.
#[derive(Debug, Serialize, ToSchema)]
struct DeliveryView {
    id: String,
    event: String,
    /// Body of the delivery.
    #[schema(value_type = Object)]
    body: Value,
    created_us: i64,
    /// Number of attempts.
    attempts: i64,
    /// Time of the next attempt; null once it has arrived or was given up.
    due_us: Option<i64>,
    /// Time of arrival; null if it has not arrived.
    delivered_us: Option<i64>,
    /// Result of the last attempt.
    answer: Option<String>,
}

impl WebhookView {
    async fn load(app: &App, row: Webhook) -> Result<Self> {
        let events = app.store().webhooks().list_events(&row.id).await?;
        let Webhook { id, title, url, ship, drift_above, created_us, ended_us, .. } = row;
        // The remaining columns hold the secret and stay internal.
        Ok(Self { id, title, url, ship, events, drift_above, created_us, ended_us })
    }
}

impl DeliveryView {
    fn from_delivery(row: Delivery) -> Self {
        let Delivery {
            id, event, body, created_us, attempts, due_us, delivered_us, answer, ..
        } = row;
        // A body that cannot be parsed is shown as null rather than refused.
        let body = serde_json::from_str(&body).unwrap_or_default();
        Self { id, event, body, created_us, attempts, due_us, delivered_us, answer }
    }
}

/// List the webhooks by id, including ended ones
#[utoipa::path(get, path = "/v1/webhooks", tag = "webhooks", params(PageQuery),
    responses((status = 200, body = Listing<WebhookView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<WebhookView>>> {
    let webhooks = app.store().webhooks().list(&query.requested_page()?).await?;
    let mut items = Vec::new();
    for webhook in webhooks.items {
        items.push(WebhookView::load(&app, webhook).await?);
    }
    let next = webhooks.next.as_ref().and_then(crate::web::page::encode_cursor);
    Ok(Json(Listing { items, next }))
}

/// Create a webhook, which notifies a URL of events
///
/// Each delivery is a `POST` of JSON with `Sistership-Event`, `Sistership-Delivery` (the same for
/// every attempt) and `Sistership-Signature`: `t=SECONDS,v1=HEX`, the HMAC-SHA256 of `SECONDS.BODY`
/// under the secret. A URL of `mailto:` gets a mail of plain text instead. It is sent until a status of 200 to 299 comes back, at least once. The answer
/// has the secret, once; the request therefore takes no `Idempotency-Key`.
#[utoipa::path(
    post, path = "/v1/webhooks", tag = "webhooks", request_body = WebhookRequest,
    responses((status = 201, body = NewWebhookView, headers(("Location" = String))))
)]
async fn create(State(app): State<App>, payload: DocumentBody) -> Result<Response> {
    let (secret, row) = create_webhook(&app, payload.parse_json()?).await?;
    let location = encode_path(&["v1", "webhooks", &row.id]);
    let about = WebhookView::load(&app, row).await?;
    let view = NewWebhookView { secret, about };
    // Neither the browser nor a proxy may store the secret.
    let head = [(header::LOCATION, location), (header::CACHE_CONTROL, "no-store".to_owned())];
    Ok((StatusCode::CREATED, head, Json(view)).into_response())
}

/// Creates a webhook as the form of a page describes it; returns its secret.
pub(super) async fn create_from_page(app: &App, asked: Value) -> Result<(String, Webhook)> {
    let asked =
        serde_json::from_value(asked).map_err(|why| Problem::invalid("form", why.to_string()))?;
    create_webhook(app, asked).await
}

async fn create_webhook(app: &App, asked: WebhookRequest) -> Result<(String, Webhook)> {
    let WebhookRequest { title, url, ship, events, drift_above } = asked;
    // The address is checked again at each delivery, as a name may lead elsewhere later.
    let receiver = check_receiver(&url, app.limits().webhooks_private)
        .map_err(|message| Problem::invalid("url", message))?;
    if matches!(receiver, Receiver::Mail(_)) && app.mail().is_none() {
        return Err(Problem::invalid("url", NO_MAIL));
    }
    let new = NewWebhook {
        title: title.into_string(),
        url: url.into_string(),
        secret: random_secret().map_err(Problem::internal)?,
        ship: ship.map(Name::into_string),
        drift_above: drift_above.map_or(DRIFT_LIMIT, Positive::get),
        events: events.into_iter().map(|event| event.as_str().to_owned()).collect(),
    };
    let row = app.store().webhooks().create(&new).await?;
    Ok((new.secret, row))
}

/// Get a webhook
#[utoipa::path(get, path = "/v1/webhooks/{id}", tag = "webhooks",
    params(("id" = inline(Id), Path)), responses((status = 200, body = WebhookView)))]
async fn get(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<WebhookView>> {
    let webhook = app.store().webhooks().get(&id).await?;
    Ok(Json(WebhookView::load(&app, webhook).await?))
}

/// Delete a webhook permanently
#[utoipa::path(delete, path = "/v1/webhooks/{id}", tag = "webhooks",
    params(("id" = inline(Id), Path)), responses((status = 200, body = WebhookView)))]
async fn end(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<WebhookView>> {
    let webhook = app.store().webhooks().end_webhook(&id).await?;
    Ok(Json(WebhookView::load(&app, webhook).await?))
}

/// List the deliveries of a webhook, the latest first
#[utoipa::path(
    get, path = "/v1/webhooks/{id}/deliveries", tag = "webhooks",
    params(("id" = inline(Id), Path), PageQuery),
    responses((status = 200, body = Listing<DeliveryView>))
)]
async fn deliveries(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<DeliveryView>>> {
    app.store().webhooks().get(&id).await?;
    let deliveries = app.store().webhooks().list_deliveries(&id, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(deliveries, DeliveryView::from_delivery)))
}

/// Send a delivery again that has not arrived
#[utoipa::path(
    post, path = "/v1/webhooks/{id}/deliveries/{delivery}/retry", tag = "webhooks",
    params(("id" = inline(Id), Path), ("delivery" = inline(Id), Path)),
    responses((status = 200, body = DeliveryView))
)]
async fn again(
    State(app): State<App>,
    PathParams((id, delivery)): PathParams<(Id, Id)>,
) -> Result<Json<DeliveryView>> {
    Ok(Json(DeliveryView::from_delivery(
        app.store().webhooks().retry_delivery(&id, &delivery).await?,
    )))
}
