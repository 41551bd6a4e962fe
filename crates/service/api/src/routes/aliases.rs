//! Aliases of versions: they move by compare-and-swap and keep their history.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use sistership_store::{Actor, Alias, AliasChange, AliasMove, ExpectedRevision, Store};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::versions::check_exists;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{SECOND_PERSON, check_ship_role};
use crate::web::conditions::entity_tag;
use crate::web::field::{EntityTags, Remark, VersionNumber};
use crate::web::{
    DocumentBody, Listing, Name, PageQuery, PathParams, QueryParams, RequestConditions,
};
use sistership_jobs::aliases::{CHAMPION, find_alias, is_reserved};

pub(super) fn alias_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(get, put)).routes(routes!(history))
}

/// Position of an alias.
#[derive(Debug, Serialize, ToSchema)]
struct AliasView {
    model: String,
    alias: String,
    /// Number of the version that it refers to.
    version: i64,
    /// Increases by one with each move; its ETag.
    revision: i64,
}

/// One move of an alias.
#[derive(Debug, Serialize, ToSchema)]
struct AliasStep {
    /// Version before the move; null for the first.
    from: Option<i64>,
    /// Version after the move.
    to: i64,
    revision: i64,
    reason: String,
    actor: String,
    moved_us: i64,
}

/// Requested position of an alias.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct AliasRequest {
    /// Number of the version.
    #[schema(inline)]
    version: VersionNumber,
    /// Reason, kept in the history.
    #[schema(inline)]
    reason: Remark,
}

impl AliasView {
    fn from_alias(alias: Alias) -> Self {
        let Alias { model, alias, version_number: version, revision } = alias;
        Self { model, alias, version, revision }
    }

    fn etag_response(self, status: StatusCode) -> Response {
        (status, [(header::ETAG, entity_tag(self.revision))], Json(self)).into_response()
    }
}

impl AliasStep {
    fn from_change(change: AliasChange) -> Self {
        let AliasChange {
            from_number: from, to_number: to, revision, reason, actor, moved_us, ..
        } = change;
        Self { from, to, revision, reason, actor, moved_us }
    }
}

/// List the aliases of a model
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases", tag = "models",
    params(("model" = inline(Name), Path), PageQuery),
    responses((status = 200, body = Listing<AliasView>))
)]
async fn list(
    State(app): State<App>,
    PathParams(model): PathParams<Name>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<AliasView>>> {
    check_exists(&app, &model).await?;
    let aliases = app.store().aliases().list(&model, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(aliases, AliasView::from_alias)))
}

/// Get the position of an alias; a move must present its ETag
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases/{alias}", tag = "models",
    params(("model" = inline(Name), Path), ("alias" = inline(Name), Path)),
    responses((status = 200, body = AliasView, headers(("ETag" = String))))
)]
async fn get(
    State(app): State<App>,
    PathParams((model, name)): PathParams<(Name, Name)>,
) -> Result<Response> {
    Ok(AliasView::from_alias(app.store().aliases().get(&model, &name).await?)
        .etag_response(StatusCode::OK))
}

/// Move an alias, or create it
#[utoipa::path(
    put, path = "/v1/models/{model}/aliases/{alias}", tag = "models",
    params(
        ("model" = inline(Name), Path), ("alias" = inline(Name), Path),
        ("If-Match" = inline(Option<EntityTags>), Header, description = "ETag of the alias from your last request, to move it"),
        ("If-None-Match" = inline(Option<EntityTags>), Header, description = "`*`, to create it")
    ),
    request_body = AliasRequest,
    responses((status = 200, body = AliasView, headers(("ETag" = String))),
    (status = 201, body = AliasView, headers(("ETag" = String))))
)]
async fn put(
    State(app): State<App>,
    PathParams((model, name)): PathParams<(Name, Name)>,
    conditions: RequestConditions,
    payload: DocumentBody,
) -> Result<Response> {
    let AliasRequest { version, reason } = payload.parse_json()?;
    // Reserved names are those that the server itself moves.
    check_alias_name(&name)?;
    let current = find_alias(app.store(), &model, &name).await?.map(|alias| alias.revision);
    // The headers If-Match and If-None-Match are the only way to state the expected position.
    let expect = conditions.expected_revision(&format!("alias `{model}/{name}`"), current)?;
    let moved = move_to(&app, &model, &name, version.get(), expect, &reason).await?;
    let status =
        if expect == ExpectedRevision::Absent { StatusCode::CREATED } else { StatusCode::OK };
    Ok(AliasView::from_alias(moved).etag_response(status))
}

/// Moves an alias if its position is as expected.
///
/// # Errors
/// Returns an error if it is not, or if the champion needs an approver.
pub(super) async fn move_to(
    app: &App,
    model: &str,
    alias: &str,
    version: i64,
    expect: ExpectedRevision,
    reason: &str,
) -> Result<Alias> {
    if alias == CHAMPION {
        check_second_person(app.store(), model).await?;
    }
    // The author is the caller, never a field of the request.
    let (alias, actor) = (alias.to_owned(), Actor::current().name);
    let change = AliasMove { alias, expect, reason: reason.to_owned(), actor };
    Ok(app.store().aliases().move_to(model, version, &change).await?)
}

/// Checks the role of an approver, if moves of the champion need a second person.
pub(super) async fn check_second_person(store: &Store, ship: &str) -> Result<()> {
    match store.settings().requires_second_person().await? {
        true => check_ship_role(store, SECOND_PERSON, ship).await,
        false => Ok(()),
    }
}

fn check_alias_name(name: &str) -> Result<()> {
    match is_reserved(name) {
        true => Err(Problem::invalid(
            "alias",
            format!("the alias `{name}` is reserved for the server; choose another name"),
        )),
        false => Ok(()),
    }
}

/// List the moves of an alias, the latest first
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases/{alias}/history", tag = "models",
    params(("model" = inline(Name), Path), ("alias" = inline(Name), Path), PageQuery),
    responses((status = 200, body = Listing<AliasStep>))
)]
async fn history(
    State(app): State<App>,
    PathParams((model, name)): PathParams<(Name, Name)>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<AliasStep>>> {
    app.store().aliases().get(&model, &name).await?;
    let changes =
        app.store().aliases().list_history(&model, &name, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(changes, AliasStep::from_change)))
}
