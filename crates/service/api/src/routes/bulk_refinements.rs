//! Refinements of all members of a family.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{
    AliasMove, BulkOutcome, ExpectedRevision, FamilyRefinement, read_all_pages,
};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::aliases::check_second_person;
use crate::app::App;
use crate::problem::Result;
use crate::web::field::{Cursor, Limit, Remark, RequestKey};
use crate::web::unit::run_in_unit;
use crate::web::{
    DocumentBody, Id, IdempotencyKey, Listing, Name, PathParams, QueryParams, StoredReply, Word,
    page,
};
use sistership_jobs::aliases::CHAMPION;
use sistership_jobs::fleet::{BulkProgress, BulkRefinementRequest, order_refinement};

pub(super) fn bulk_routes() -> OpenApiRouter<App> {
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
    /// The request, with all defaults filled in.
    #[schema(value_type = Object)]
    request: Value,
    #[serde(flatten)]
    standing: BulkProgress,
}

/// Outcome of a bulk refinement for one ship.
#[derive(Debug, Serialize, ToSchema)]
struct OutcomeView {
    ship: String,
    /// `champion`, `candidate`, `unchanged` or `refused`.
    outcome: String,
    /// Number of the resulting version.
    version: Option<i64>,
    /// Relative change of the error on the axis that is worst; negative if all axes are better.
    worst_change: Option<f64>,
    /// Errors by axis and manoeuvres before and after, or the reason for the outcome.
    #[schema(value_type = Object)]
    comparison: Value,
}

/// A person's decision to promote candidates of this refinement.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Promotion {
    /// Person who decides.
    #[schema(inline)]
    actor: Remark,
    /// Reason.
    #[schema(inline)]
    reason: Remark,
    /// The ships; by default every candidate.
    #[schema(inline)]
    ships: Option<Vec<Name>>,
}

/// Result of a promotion.
#[derive(Debug, Serialize, ToSchema)]
struct PromotionResult {
    /// Number of candidates that have become champions.
    champions: usize,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct BulkListQuery {
    /// Only refinements of this family.
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
struct OutcomeQuery {
    /// Only ships with this outcome.
    #[param(inline)]
    outcome: Option<Outcome>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

/// Outcome of a bulk refinement for one ship.
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
    async fn load(app: &App, bulk: FamilyRefinement) -> Result<Self> {
        let standing = BulkProgress::read_current(app.store(), &bulk).await?;
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
    fn from_outcome(outcome: BulkOutcome) -> Self {
        let comparison = serde_json::from_str(&outcome.document).unwrap_or_default();
        let BulkOutcome { ship, outcome, version, worst_change, .. } = outcome;
        Self { ship, outcome, version, worst_change, comparison }
    }
}

/// Refine every member of a family from the statistics of its trials
///
/// The ships are distributed in chunks, each a job, over all workers. A version becomes champion
/// only by the rule given here, or by a person's decision afterwards.
#[utoipa::path(
    post, path = "/v1/families/{family}/refinements", tag = "families",
    params(("family" = inline(Word), Path),
    ("Idempotency-Key" = inline(Option<RequestKey>), Header, description = "Key that makes it safe to repeat the request")),
    request_body = BulkRefinementRequest, responses((status = 202, body = BulkView, headers(("Location" = String))))
)]
async fn refine(
    State(app): State<App>,
    PathParams(family): PathParams<Word>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let asked: BulkRefinementRequest = payload.parse_json()?;
    // Bulk refinement and jobs are queued in one transaction.
    let work = |app: App| async move {
        let bulk = order_refinement(app.store(), &family, &asked).await?;
        let id = bulk.id.clone();
        Ok(StoredReply::new(StatusCode::ACCEPTED, &BulkView::load(&app, bulk).await?)?
            .with_location(&["v1", "bulk-refinements", &id]))
    };
    key.run_once(&app, payload.bytes(), work).await
}

/// List the bulk refinements, the latest first
#[utoipa::path(
    get, path = "/v1/bulk-refinements", tag = "families", params(BulkListQuery),
    responses((status = 200, body = Listing<BulkView>))
)]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<BulkListQuery>,
) -> Result<Json<Listing<BulkView>>> {
    let bulks = app
        .store()
        .bulks()
        .list(query.family.as_deref(), &page::parse_page(query.limit, query.after.as_ref())?)
        .await?;
    let mut items = Vec::with_capacity(bulks.items.len());
    // The status of each is counted from its chunks, hence look-ups for each item; a page has few.
    for bulk in bulks.items {
        items.push(BulkView::load(&app, bulk).await?);
    }
    Ok(Json(Listing { items, next: bulks.next }))
}

/// Get the state of a bulk refinement
#[utoipa::path(
    get, path = "/v1/bulk-refinements/{id}", tag = "families", params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn get(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    Ok(Json(BulkView::load(&app, bulk).await?))
}

/// Cancel the rest of a bulk refinement; ships that are done keep their outcome
#[utoipa::path(
    delete, path = "/v1/bulk-refinements/{id}", tag = "families", params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn cancel(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    app.store().bulks().request_cancel(&id).await?;
    Ok(Json(BulkView::load(&app, bulk).await?))
}

/// Run the chunks again that failed or were cancelled
#[utoipa::path(
    post, path = "/v1/bulk-refinements/{id}/retry", tag = "families",
    params(("id" = inline(Id), Path)),
    responses((status = 200, body = BulkView))
)]
async fn retry(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<BulkView>> {
    let bulk = app.store().bulks().get(&id).await?;
    app.store().bulks().retry_chunks(&id).await?;
    Ok(Json(BulkView::load(&app, bulk).await?))
}

/// List the ships of a bulk refinement with their errors before and after
#[utoipa::path(
    get, path = "/v1/bulk-refinements/{id}/ships", tag = "families",
    params(("id" = inline(Id), Path), OutcomeQuery),
    responses((status = 200, body = Listing<OutcomeView>))
)]
async fn ships(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    QueryParams(query): QueryParams<OutcomeQuery>,
) -> Result<Json<Listing<OutcomeView>>> {
    let bulk = app.store().bulks().get(&id).await?;
    let page = page::parse_page(query.limit, query.after.as_ref())?;
    let outcomes = app
        .store()
        .bulks()
        .list_outcomes(&bulk.id, query.outcome.map(Outcome::name), &page)
        .await?;
    Ok(Json(Listing::from_list(outcomes, OutcomeView::from_outcome)))
}

/// Promote candidates of a bulk refinement to champions
#[utoipa::path(
    post, path = "/v1/bulk-refinements/{id}/champions", tag = "families",
    params(("id" = inline(Id), Path)), request_body = Promotion,
    responses((status = 200, body = PromotionResult))
)]
async fn promote(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    payload: DocumentBody,
) -> Result<Json<PromotionResult>> {
    let promotion: Promotion = payload.parse_json()?;
    let bulk = app.store().bulks().get(&id).await?;
    let work = |app: App| async move { promotion.promote_candidates(&app, &bulk.id).await };
    Ok(Json(PromotionResult { champions: run_in_unit(&app, work).await? }))
}

impl Promotion {
    /// Promotes the candidates that are meant, and returns their number.
    async fn promote_candidates(self, app: &App, bulk: &str) -> Result<usize> {
        let bulks = app.store().bulks();
        let list = |page| async move { bulks.list_outcomes(bulk, Some("candidate"), &page).await };
        let candidates: Vec<BulkOutcome> = read_all_pages(list).await?;
        let change = self.alias_move();
        let mut champions = 0;
        for BulkOutcome { ship, version, .. } in candidates {
            let Some(version) = version.filter(|_| self.includes_ship(&ship)) else { continue };
            // The role of an approver may depend on the ship, so that it is checked for each.
            check_second_person(app.store(), &ship).await?;
            bulks.promote_candidate(bulk, &ship, version, &change).await?;
            champions += 1;
        }
        Ok(champions)
    }

    fn includes_ship(&self, ship: &str) -> bool {
        self.ships.as_ref().is_none_or(|ships| ships.iter().any(|named| **named == *ship))
    }

    fn alias_move(&self) -> AliasMove {
        AliasMove {
            alias: CHAMPION.to_owned(),
            expect: ExpectedRevision::Any,
            reason: self.reason.to_string(),
            actor: self.actor.to_string(),
        }
    }
}
