//! Simulation sessions: a version is simulated step by step as orders come.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use serde_json::{Value, json};
use sistership_auth::Role;
use sistership_jobs::predictions::session::{
    PredictionSession, SessionHandle, SessionRequest, StepsRequest,
};
use sistership_model::Model;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::model_ref::resolve_version;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{check_ship_role, current_actor};
use crate::web::{DocumentBody, Id, PathParams, StoredReply};

pub(super) fn session_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(open, list))
        .routes(routes!(show, close))
        .routes(routes!(steps))
}

/// Returns the owner of the sessions that a request may see: the caller.
pub(super) fn session_owner() -> Result<String> {
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    Ok(acting.principal.name.clone())
}

/// Returns a session of the caller, who must still have a role for its ship.
pub(super) async fn find_session(app: &App, id: &str) -> Result<SessionHandle> {
    let handle = app.sessions().find_session(id, &session_owner()?)?;
    let ship = handle.about["model"].as_str().unwrap_or_default();
    check_ship_role(app.store(), Role::Reader, ship).await?;
    Ok(handle)
}

/// Open a simulation session
///
/// A version of a model is simulated as orders come, by `/steps` or over `/stream`, together with
/// draws of its posterior if these are requested. Sessions are in the memory of the process that
/// has opened them and belong to their caller; they end after ten minutes without a request.
#[utoipa::path(
    post, path = "/v1/sessions", tag = "predictions", request_body = SessionRequest,
    responses((status = 201, body = Object, headers(("Location" = String)),
        description = "As `GET /v1/sessions/{id}`"))
)]
async fn open(State(app): State<App>, payload: DocumentBody) -> Result<StoredReply> {
    let request: SessionRequest = payload.parse_json()?;
    let owner = session_owner()?;
    // Before the model is read, as a refusal must be cheap.
    app.sessions().check_room(&owner)?;
    let version = resolve_version(app.store(), "model", &request.model).await?;
    let model: Model = app.archive().model_with_weights(&version).await?;
    let law = app.stored_law(&model.law).await?;
    let session =
        app.run_blocking(move || PredictionSession::new(&request, &model, &law)).await??;
    let (id, head) = (Uuid::new_v4().to_string(), version.head);
    let about = json!({
        "model": head.model, "version": head.number, "sha256": head.sha256, "law": head.law,
    });
    let answer = session_view(&id, &about, session.current_view());
    app.sessions().open(&id, &owner, about, session)?;
    Ok(StoredReply::new(StatusCode::CREATED, &answer)?.with_location(&["v1", "sessions", &id]))
}

/// List the caller's sessions
#[utoipa::path(
    get, path = "/v1/sessions", tag = "predictions",
    responses((status = 200, body = Object,
        description = "`items`: `id`, `model`, `version`, `sha256`, `law` of each"))
)]
async fn list(State(app): State<App>) -> Result<Json<Value>> {
    let own = app.sessions().list_sessions(&session_owner()?);
    let items: Vec<Value> =
        own.iter().map(|(id, about)| session_view(id, about, json!({}))).collect();
    Ok(Json(json!({ "items": items })))
}

/// Get the present state of a session
#[utoipa::path(
    get, path = "/v1/sessions/{id}", tag = "predictions", params(("id" = inline(Id), Path)),
    responses((status = 200, body = Object,
        description = "`id`, `model`, `version`, `sha256`, `law`; the state under canonical \
                       names, `t_s`; `orders`; `draws`, and with them `band`: of each state `low` \
                       and `high`, between which 95 % of the draws are; `stopped` with `reason` \
                       if the motion has left the physical range; `outside` if it is outside the \
                       range covered by the model's trials"))
)]
async fn show(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<Value>> {
    let handle = find_session(&app, &id).await?;
    let about = handle.about.clone();
    let now = app
        .run_blocking(move || handle.with_session(|session| Ok(session.current_view())))
        .await??;
    Ok(Json(session_view(&id, &about, now)))
}

/// Advance a session by steps
///
/// Orders go through the steering gear: the rudder follows within its limit, at its rate. Orders
/// that are not given stay as before.
#[utoipa::path(
    post, path = "/v1/sessions/{id}/steps", tag = "predictions", params(("id" = inline(Id), Path)),
    request_body = StepsRequest,
    responses((status = 200, body = Object,
        description = "`t_s`, the present time; `trajectory` under canonical names, one sample \
                       per step; `band`: `low` and `high` likewise, the number `drawn` and the \
                       number still `sailing` (within the physical range); `stopped` if the \
                       motion has left the physical range, after which there are no samples; \
                       `outside`; `branch_share`"))
)]
async fn steps(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    payload: DocumentBody,
) -> Result<Json<Value>> {
    let request: StepsRequest = payload.parse_json()?;
    let (handle, most) = (find_session(&app, &id).await?, app.limits().prediction_samples);
    let sail = move || handle.with_session(|session| session.simulate(&request, most));
    Ok(Json(app.run_blocking(sail).await??))
}

/// End a session
#[utoipa::path(
    delete, path = "/v1/sessions/{id}", tag = "predictions", params(("id" = inline(Id), Path)),
    responses((status = 204))
)]
async fn close(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<StatusCode> {
    app.sessions().close(&id, &session_owner()?)?;
    Ok(StatusCode::NO_CONTENT)
}

fn session_view(id: &str, about: &Value, mut now: Value) -> Value {
    now["id"] = json!(id);
    about.as_object().into_iter().flatten().for_each(|(name, value)| now[name] = value.clone());
    now
}
