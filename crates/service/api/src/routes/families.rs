//! Families of ships.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{Family, FamilyMember, FamilyPrior, MAX_LIMIT, NewJob, StoreError};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use super::model_ref::resolve_version;
use super::queue::job_reply;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{Remark, RequestKey};
use crate::web::{
    DocumentBody, IdempotencyKey, Listing, ModelName, Name, Number, PageQuery, PathParams,
    QueryParams, StoredReply, Word,
};
use sistership_jobs::fleet::{LearnJob, PRIOR_JOB_KIND};

pub(super) fn family_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list, create))
        .routes(routes!(get, found))
        .routes(routes!(members, add))
        .routes(routes!(remove))
        .routes(routes!(prior, learn))
}

/// A family: ships whose models share a foundation.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct FamilyView {
    pub name: String,
    /// Display name.
    pub title: String,
    /// Version from which the members' models are refined, `ship/number`.
    pub foundation: String,
    /// Number of its ships.
    pub members: i64,
    /// Latest revision of its prior; null if there is none.
    pub prior: Option<i64>,
    pub created_us: i64,
}

/// A member of a family.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct MemberView {
    pub ship: String,
    pub added_us: i64,
    /// Number of its champion, if it has one.
    pub champion: Option<i64>,
    /// Method by which the champion was made.
    pub method: Option<String>,
}

/// Prior that was learned from the members of a family.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct PriorView {
    pub family: String,
    /// 1, 2, 3, ...
    pub revision: i64,
    /// Hash of the document.
    pub sha256: String,
    pub created_us: i64,
    /// Means, deviations and correlations of the coefficients by axis, and the data they were
    /// learned from.
    #[schema(value_type = Object)]
    pub document: Value,
}

/// A family to be created.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewFamily {
    /// Its name, which appears in URLs.
    #[schema(inline)]
    name: Word,
    /// Display name; by default the name.
    #[schema(inline)]
    title: Option<Remark>,
    /// Version from which the members' models are refined: `ship` (its champion), `ship/number`,
    /// `ship/alias`.
    #[schema(inline)]
    foundation: ModelName,
    /// Its first members.
    #[serde(default)]
    #[schema(inline, max_items = 1000)]
    members: Vec<Name>,
}

/// A new foundation of a family.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewFoundation {
    /// The version: `ship` (its champion), `ship/number`, `ship/alias`.
    #[schema(inline)]
    foundation: ModelName,
}

/// Ships to be added.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewMembers {
    /// Names of ships.
    #[schema(inline, max_items = 1000)]
    ships: Vec<Name>,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct RevisionQuery {
    /// Revision of the prior; by default the latest.
    #[param(inline)]
    revision: Option<Number>,
}

impl FamilyView {
    async fn load(app: &App, family: Family) -> Result<Self> {
        let store = app.store();
        let foundation = store.versions().by_id(&family.foundation).await?.head;
        // A family without a prior is not an error of the request.
        let prior = match store.families().get_prior(&family.name, None).await {
            Err(StoreError::NotFound { .. }) => None,
            other => Some(other?.revision),
        };
        let members = store.families().count_members(&family.name).await?;
        let foundation = format!("{}/{}", foundation.model, foundation.number);
        let Family { name, title, created_us, .. } = family;
        Ok(Self { name, title, foundation, members, prior, created_us })
    }
}

impl MemberView {
    pub(super) fn from_member(member: FamilyMember) -> Self {
        let FamilyMember { ship, added_us, champion, method } = member;
        Self { ship, added_us, champion, method }
    }
}

/// List the families by name
#[utoipa::path(get, path = "/v1/families", tag = "families", params(PageQuery),
    responses((status = 200, body = Listing<FamilyView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<FamilyView>>> {
    let families = app.store().families().list(&query.requested_page()?).await?;
    let mut items = Vec::with_capacity(families.items.len());
    for family in families.items {
        items.push(FamilyView::load(&app, family).await?);
    }
    Ok(Json(Listing { items, next: families.next }))
}

/// Create a family on a foundation
#[utoipa::path(
    post, path = "/v1/families", tag = "families",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body = NewFamily,
    responses((status = 201, body = FamilyView, headers(("Location" = String))))
)]
async fn create(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let new: NewFamily = payload.parse_json()?;
    // The work runs in one transaction with the key: family and members are kept together or not at
    // all.
    let work = |app: App| async move {
        let family = create_family(&app, new).await?;
        let name = family.name.clone();
        let reply = StoredReply::new(StatusCode::CREATED, &FamilyView::load(&app, family).await?)?;
        Ok(reply.with_location(&["v1", "families", &name]))
    };
    key.run_once(&app, payload.bytes(), work).await
}

async fn create_family(app: &App, new: NewFamily) -> Result<Family> {
    let members = check_ship_count("members", new.members)?;
    let foundation = resolve_version(app.store(), "foundation", &new.foundation).await?.head;
    let title = new.title.as_deref().unwrap_or(&new.name);
    let family = app.store().families().create(&new.name, title, &foundation.id).await?;
    app.store().families().add_members(&family.name, &members).await?;
    Ok(family)
}

/// Creates a family as the form of a page describes it.
pub(super) async fn create_from_page(app: &App, asked: Value) -> Result<Family> {
    let new: NewFamily =
        serde_json::from_value(asked).map_err(|why| Problem::invalid("form", why.to_string()))?;
    // Before the family is written: a wrong name leaves none behind.
    for ship in &new.members {
        app.store().ships().get(ship).await?;
    }
    create_family(app, new).await
}

/// Get a family
#[utoipa::path(
    get, path = "/v1/families/{family}", tag = "families", params(("family" = inline(Word), Path)),
    responses((status = 200, body = FamilyView))
)]
async fn get(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
) -> Result<Json<FamilyView>> {
    let family = app.store().families().get(&name).await?;
    Ok(Json(FamilyView::load(&app, family).await?))
}

/// Replace the foundation of a family; models are refined from it when the family is refined next
#[utoipa::path(
    put, path = "/v1/families/{family}", tag = "families", params(("family" = inline(Word), Path)),
    request_body = NewFoundation, responses((status = 200, body = FamilyView))
)]
async fn found(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
    payload: DocumentBody,
) -> Result<Json<FamilyView>> {
    let new: NewFoundation = payload.parse_json()?;
    let foundation = resolve_version(app.store(), "foundation", &new.foundation).await?.head;
    let family = app.store().families().set_foundation(&name, &foundation.id).await?;
    Ok(Json(FamilyView::load(&app, family).await?))
}

/// List the members of a family by name
#[utoipa::path(
    get, path = "/v1/families/{family}/members", tag = "families",
    params(("family" = inline(Word), Path), PageQuery),
    responses((status = 200, body = Listing<MemberView>))
)]
async fn members(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<MemberView>>> {
    let family = app.store().families().get(&name).await?;
    let members =
        app.store().families().list_members(&family.name, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(members, MemberView::from_member)))
}

/// Add ships to a family, all or none; members stay members
#[utoipa::path(
    post, path = "/v1/families/{family}/members", tag = "families",
    params(("family" = inline(Word), Path)),
    request_body = NewMembers, responses((status = 200, body = FamilyView))
)]
async fn add(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
    payload: DocumentBody,
) -> Result<Json<FamilyView>> {
    let new: NewMembers = payload.parse_json()?;
    let ships = check_ship_count("ships", new.ships)?;
    app.store().families().add_members(&name, &ships).await?;
    // The answer is read after the change, so that it has the present number of members.
    get(State(app), PathParams(name)).await
}

/// Remove a ship from a family
#[utoipa::path(
    delete, path = "/v1/families/{family}/members/{ship}", tag = "families",
    params(("family" = inline(Word), Path), ("ship" = inline(Name), Path)),
    responses((status = 200, body = FamilyView))
)]
async fn remove(
    State(app): State<App>,
    PathParams((name, ship)): PathParams<(Word, Name)>,
) -> Result<Json<FamilyView>> {
    // A ship that is no member is an error, so that a misspelt name does not pass unnoticed.
    match app.store().families().remove_member(&name, &ship).await? {
        true => get(State(app), PathParams(name)).await,
        false => Err(StoreError::NotFound { kind: "member", id: format!("{name}/{ship}") }.into()),
    }
}

/// Get the prior of a family: the variation of each coefficient over its members
#[utoipa::path(
    get, path = "/v1/families/{family}/prior", tag = "families",
    params(("family" = inline(Word), Path), RevisionQuery),
    responses((status = 200, body = PriorView))
)]
async fn prior(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
    QueryParams(query): QueryParams<RevisionQuery>,
) -> Result<Json<PriorView>> {
    let prior = app.store().families().get_prior(&name, query.revision.map(Number::get)).await?;
    let document = serde_json::from_str(&prior.document).map_err(Problem::internal)?;
    let FamilyPrior { family, revision, sha256, created_us, .. } = prior;
    Ok(Json(PriorView { family, revision, sha256, created_us, document }))
}

/// Learn the variation of the coefficients from the members' trials; the work is a job
#[utoipa::path(
    post, path = "/v1/families/{family}/prior", tag = "families",
    params(("family" = inline(Word), Path)),
    responses((status = 202, body = JobView, headers(("Location" = String))))
)]
async fn learn(State(app): State<App>, PathParams(name): PathParams<Word>) -> Result<StoredReply> {
    let family = app.store().families().get(&name).await?;
    let request =
        serde_json::to_string(&LearnJob { family: family.name }).map_err(Problem::internal)?;
    // The job belongs to no ship; access to it is decided by the family in its request.
    let new = NewJob { kind: PRIOR_JOB_KIND.to_owned(), ship: None, request, small: false };
    let job = app.store().jobs().enqueue(&new).await?;
    job_reply(&app, job).await
}

fn check_ship_count(field: &str, ships: Vec<Name>) -> Result<Vec<String>> {
    match i64::try_from(ships.len()) {
        Ok(count) if count <= MAX_LIMIT => Ok(ships.into_iter().map(Name::into_string).collect()),
        _ => Err(Problem::invalid(
            field,
            format!("are more than {MAX_LIMIT}; add them in several requests"),
        )),
    }
}
