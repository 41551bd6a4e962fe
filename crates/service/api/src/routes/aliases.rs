//! Aliases of versions: they move by compare-and-swap and keep their history.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use sistership_store::{Actor, Alias, AliasChange, AliasMove, Expect, Store};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::versions::exists;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{SECOND_PERSON, on_ship};
use crate::web::conditions::tag;
use crate::web::field::{EntityTags, Remark, VersionNumber};
use crate::web::{Conditions, Listing, Name, Paged, Params, Payload, Place};
use sistership_jobs::line::{CHAMPION, alias, is_reserved};

pub(super) fn routes() -> OpenApiRouter<App> {
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
    fn of(alias: Alias) -> Self {
        let Alias { model, alias, version_number: version, revision } = alias;
        Self { model, alias, version, revision }
    }

    fn answer(self, status: StatusCode) -> Response {
        (status, [(header::ETAG, tag(self.revision))], Json(self)).into_response()
    }
}

impl AliasStep {
    fn of(change: AliasChange) -> Self {
        let AliasChange {
            from_number: from, to_number: to, revision, reason, actor, moved_us, ..
        } = change;
        Self { from, to, revision, reason, actor, moved_us }
    }
}

/// List the aliases of a model
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases", tag = "models",
    params(("model" = inline(Name), Path), Paged),
    responses((status = 200, body = Listing<AliasView>))
)]
async fn list(
    State(app): State<App>,
    Place(model): Place<Name>,
    Params(query): Params<Paged>,
) -> Result<Json<Listing<AliasView>>> {
    exists(&app, &model).await?;
    let aliases = app.store().aliases().list(&model, &query.page()?).await?;
    Ok(Json(Listing::of(aliases, AliasView::of)))
}

/// Get the position of an alias; a move must present its ETag
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases/{alias}", tag = "models",
    params(("model" = inline(Name), Path), ("alias" = inline(Name), Path)),
    responses((status = 200, body = AliasView, headers(("ETag" = String))))
)]
async fn get(
    State(app): State<App>,
    Place((model, name)): Place<(Name, Name)>,
) -> Result<Response> {
    Ok(AliasView::of(app.store().aliases().get(&model, &name).await?).answer(StatusCode::OK))
}

/// Move an alias, or create it
#[utoipa::path(
    put, path = "/v1/models/{model}/aliases/{alias}", tag = "models",
    params(
        ("model" = inline(Name), Path), ("alias" = inline(Name), Path),
        ("If-Match" = inline(Option<EntityTags>), Header, description = "The ETag of the alias as \
            you last read it, to move it"),
        ("If-None-Match" = inline(Option<EntityTags>), Header, description = "`*`, to create it")
    ),
    request_body = AliasRequest,
    responses((status = 200, body = AliasView, headers(("ETag" = String))),
    (status = 201, body = AliasView, headers(("ETag" = String))))
)]
async fn put(
    State(app): State<App>,
    Place((model, name)): Place<(Name, Name)>,
    conditions: Conditions,
    payload: Payload,
) -> Result<Response> {
    let AliasRequest { version, reason } = payload.json()?;
    // Reserved names are those that the server itself moves.
    check(&name)?;
    let current = alias(app.store(), &model, &name).await?.map(|alias| alias.revision);
    // The headers If-Match and If-None-Match are the only way to state the expected position.
    let expect = conditions.expect(&format!("alias `{model}/{name}`"), current)?;
    let moved = move_to(&app, &model, &name, version.get(), expect, &reason).await?;
    let status = if expect == Expect::Absent { StatusCode::CREATED } else { StatusCode::OK };
    Ok(AliasView::of(moved).answer(status))
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
    expect: Expect,
    reason: &str,
) -> Result<Alias> {
    if alias == CHAMPION {
        second_person(app.store(), model).await?;
    }
    // The author is the caller, never a field of the request.
    let (alias, actor) = (alias.to_owned(), Actor::current().name);
    let change = AliasMove { alias, expect, reason: reason.to_owned(), actor };
    Ok(app.store().aliases().move_to(model, version, &change).await?)
}

/// Checks the role of an approver, if moves of the champion need a second person.
pub(super) async fn second_person(store: &Store, ship: &str) -> Result<()> {
    match store.settings().second_person().await? {
        true => on_ship(store, SECOND_PERSON, ship).await,
        false => Ok(()),
    }
}

fn check(name: &str) -> Result<()> {
    match is_reserved(name) {
        true => Err(Problem::invalid(
            "alias",
            format!("`{name}` is moved by the server itself; choose another name"),
        )),
        false => Ok(()),
    }
}

/// List the moves of an alias, the latest first
#[utoipa::path(
    get, path = "/v1/models/{model}/aliases/{alias}/history", tag = "models",
    params(("model" = inline(Name), Path), ("alias" = inline(Name), Path), Paged),
    responses((status = 200, body = Listing<AliasStep>))
)]
async fn history(
    State(app): State<App>,
    Place((model, name)): Place<(Name, Name)>,
    Params(query): Params<Paged>,
) -> Result<Json<Listing<AliasStep>>> {
    app.store().aliases().get(&model, &name).await?;
    let changes = app.store().aliases().history(&model, &name, &query.page()?).await?;
    Ok(Json(Listing::of(changes, AliasStep::of)))
}
