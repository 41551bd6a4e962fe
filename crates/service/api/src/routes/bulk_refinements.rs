//! Refinements of all members of a family.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{AliasMove, Bulk, BulkOutcome, Expect, MAX_LIMIT, Page};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::aliases::second_person;
use crate::app::App;
use crate::problem::Result;
use crate::web::field::{Cursor, Limit, Remark, RequestKey};
use crate::web::{Id, Key, Listing, Name, Params, Payload, Place, Reply, Word, page};
use sistership_jobs::fleet::{Asked, Standing, order_refinement};
use sistership_jobs::line::CHAMPION;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(refine))
        .routes(routes!(list))
        .routes(routes!(get, cancel))
        .routes(routes!(retry))
        .routes(routes!(ships))
        .routes(routes!(promote))
}

/// A refinement of all members of a family.
#[derive(Debug, Serialize, ToSchema)]
struct BulkView {
    id: String,
    family: String,
    created_us: i64,
    /// What was asked, with everything looked up.
    #[schema(value_type = Object)]
    request: Value,
    #[serde(flatten)]
    standing: Standing,
}

/// What has become of a ship.
#[derive(Debug, Serialize, ToSchema)]
struct OutcomeView {
    ship: String,
    /// `champion`, `candidate`, `unchanged` or `refused`.
    outcome: String,
    /// The version that came of it.
    version: Option<i64>,
    /// By how much its worst axis is worse than before, as a share; below zero where all are
    /// better.
    worst_change: Option<f64>,
    /// Errors by axis and manoeuvres before and after, or the reason why not.
    #[schema(value_type = Object)]
    comparison: Value,
}

/// A person's word for candidates of this refinement.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Promotion {
    /// Who says so.
    #[schema(inline)]
    actor: Remark,
    /// Why.
    #[schema(inline)]
    reason: Remark,
    /// The ships; every candidate where absent.
    #[schema(inline)]
    ships: Option<Vec<Name>>,
}

/// What a person's word has done.
#[derive(Debug, Serialize, ToSchema)]
struct Promoted {
    /// How many candidates have become champions.
    champions: usize,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ListQuery {
    /// Of this family only.
    #[param(inline)]
    family: Option<Word>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ShipQuery {
    /// With this outcome only.
    #[param(inline)]
    outcome: Option<Outcome>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

/// What may have become of a ship.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum Outcome {
    Champion,
    Candidate,
    Unchanged,
    Refused,
}

impl Outcome {
    fn name(self) -> &'static str {
        match self {
            Self::Champion => "champion",
            Self::Candidate => "candidate",
            Self::Unchanged => "unchanged",
            Self::Refused => "refused",
        }
    }
}

impl BulkView {
    async fn of(app: &App, bulk: Bulk) -> Result<Self> {
        let standing = Standing::of(app.store(), &bulk).await?;
        let request = serde_json::from_str(&bulk.request).unwrap_or_default();
        Ok(Self {
            id: bulk.id,
            family: bulk.family,
            created_us: bulk.created_us,
            request,
            standing,
        })
    }
}

impl OutcomeView {
    fn of(outcome: BulkOutcome) -> Self {
        let comparison = serde_json::from_str(&outcome.document).unwrap_or_default();
        let BulkOutcome { ship, outcome, version, worst_change, .. } = outcome;
        Self { ship, outcome, version, worst_change, comparison }
    }
}

/// Refine every member of a family from the statistics of its trials
///
/// The ships are shared out among all workers in chunks, each a job. Nothing becomes champion but
/// by the rule given here, or by a person's word afterwards.
#[utoipa::path(
    post, path = "/v1/families/{family}/refinements", tag = "families",
    params(("family" = inline(Word), Path),
    ("Idempotency-Key" = inline(Option<RequestKey>), Header, description = "Repeat the request safely under this key")),
    request_body = Asked, responses((status = 202, body = BulkView, headers(("Location" = String))))
)]
async fn refine(
    State(app): State<App>,
    Place(family): Place<Word>,
    key: Key,
    payload: Payload,
) -> Result<Response> {
    let asked: Asked = payload.json()?;
    let work = |app: App| async move {
        let bulk = order_refinement(app.store(), &family, &asked).await?;
        let id = bulk.id.clone();
        Ok(Reply::new(StatusCode::ACCEPTED, &BulkView::of(&app, bulk).await?)?
            .at(&["v1", "bulk-refinements", &id])
            .with_jobs())
    };
    key.once(&app, payload.bytes(), work).await
}

/// List the refinements of families, the latest first
#[utoipa::path(
    get, path = "/v1/bulk-refinements", tag = "families", params(ListQuery),
    responses((status = 200, body = Listing<BulkView>))
)]
async fn list(
    State(app): State<App>,
    Params(query): Params<ListQuery>,
) -> Result<Json<Listing<BulkView>>> {
    let bulks = app
        .store()
        .bulks()
        .list(query.family.as_deref(), &page::page(query.limit, query.after.as_ref())?)
        .await?;
    let mut items = Vec::with_capacity(bulks.items.len());
    for bulk in bulks.items {
        items.push(BulkView::of(&app, bulk).await?);
    }
    Ok(Json(Listing { items, next: bulks.next }))
}

/// How far a refinement of a family is
#[utoipa::path(
    get, path = "/v1/bulk-refinements/{id}", tag = "families", params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn get(State(app): State<App>, Place(id): Place<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    Ok(Json(BulkView::of(&app, bulk).await?))
}

/// Cancel what is left of a refinement; ships that are done stay so
#[utoipa::path(
    delete, path = "/v1/bulk-refinements/{id}", tag = "families", params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn cancel(State(app): State<App>, Place(id): Place<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    app.store().bulks().request_cancel(&id).await?;
    Ok(Json(BulkView::of(&app, bulk).await?))
}

/// Go on with the chunks that failed or were cancelled
#[utoipa::path(
    post, path = "/v1/bulk-refinements/{id}/retry", tag = "families",
    params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn retry(State(app): State<App>, Place(id): Place<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    app.store().bulks().retry(&id).await?;
    app.wake().notify_waiters();
    Ok(Json(BulkView::of(&app, bulk).await?))
}

/// Every ship of a refinement, before and after
#[utoipa::path(
    get, path = "/v1/bulk-refinements/{id}/ships", tag = "families",
    params(("id" = inline(Id), Path), ShipQuery),
    responses((status = 200, body = Listing<OutcomeView>))
)]
async fn ships(
    State(app): State<App>,
    Place(id): Place<Id>,
    Params(query): Params<ShipQuery>,
) -> Result<Json<Listing<OutcomeView>>> {
    let bulk = app.store().bulks().get(&id).await?;
    let page = page::page(query.limit, query.after.as_ref())?;
    let outcomes =
        app.store().bulks().outcomes(&bulk.id, query.outcome.map(Outcome::name), &page).await?;
    Ok(Json(Listing::of(outcomes, OutcomeView::of)))
}

/// Make candidates of a refinement champions, by a person's word
#[utoipa::path(
    post, path = "/v1/bulk-refinements/{id}/champions", tag = "families",
    params(("id" = inline(Id), Path)), request_body = Promotion,
    responses((status = 200, body = Promoted))
)]
async fn promote(
    State(app): State<App>,
    Place(id): Place<Id>,
    payload: Payload,
) -> Result<Json<Promoted>> {
    let word: Promotion = payload.json()?;
    let bulk = app.store().bulks().get(&id).await?;
    let (reason, actor) = (word.reason.into_string(), word.actor.into_string());
    let change = AliasMove { alias: CHAMPION.to_owned(), expect: Expect::Any, reason, actor };
    let (mut champions, mut page) = (0, Page::first(MAX_LIMIT));
    loop {
        let list = app.store().bulks().outcomes(&bulk.id, Some("candidate"), &page).await?;
        for outcome in &list.items {
            let meant = word
                .ships
                .as_ref()
                .is_none_or(|ships| ships.iter().any(|ship| **ship == *outcome.ship));
            if let (true, Some(version)) = (meant, outcome.version) {
                second_person(app.store(), &outcome.ship).await?;
                app.store().bulks().promote(&bulk.id, &outcome.ship, version, &change).await?;
                champions += 1;
            }
        }
        let Some(next) = list.next else { return Ok(Json(Promoted { champions })) };
        page = Page::after(next, MAX_LIMIT);
    }
}
