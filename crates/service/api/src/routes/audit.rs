//! What has been done by whom, and the settings that are recorded there.

use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{AuditEntry, AuditFilter};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::web::field::{AuditName, Cursor, Limit};
use crate::web::{Listing, Params, Payload, page};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(head))
        .routes(routes!(settings, set_settings))
}

/// An entry of the audit.
#[derive(Debug, Serialize, ToSchema)]
struct EntryView {
    /// 1, 2, 3, ...
    number: i64,
    at_us: i64,
    /// Who: a user, `key:PREFIX`, `server-key`, `local`, `command-line` or `sistership` itself.
    actor: String,
    /// From where: an address, a job, a process.
    origin: String,
    /// What, such as `alias.move`.
    action: String,
    /// To what, such as `ship:kvlcc2`.
    subject: String,
    /// What was true of it before; null where it was not there.
    #[schema(value_type = Option<Object>)]
    before: Option<Value>,
    /// What is true of it since; null where it is gone.
    #[schema(value_type = Option<Object>)]
    after: Option<Value>,
    /// The hash of the entry before; empty for the first.
    previous_sha256: String,
    /// The hash of the entry and of the one before it.
    sha256: String,
}

/// The last entry of the audit.
#[derive(Debug, Serialize, ToSchema)]
struct HeadView {
    /// Its number; 0 where there is none.
    number: i64,
    /// Its hash: who keeps it elsewhere can tell later that nothing before it was written anew.
    sha256: String,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct Query {
    /// By this one only.
    #[param(inline)]
    actor: Option<AuditName>,
    /// About this only.
    #[param(inline)]
    subject: Option<AuditName>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

/// Settings that hold for every process on the store.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// Whether a version becomes champion only by the word of an approver who has not made it.
    second_person: bool,
}

impl EntryView {
    fn of(entry: AuditEntry) -> Self {
        let AuditEntry { number, at_us, actor, origin, action, subject, .. } = entry;
        let read = |text: Option<String>| text.and_then(|text| serde_json::from_str(&text).ok());
        let (before, after) = (read(entry.state_before), read(entry.state_after));
        let (previous_sha256, sha256) = (entry.previous_sha256, entry.sha256);
        Self {
            number,
            at_us,
            actor,
            origin,
            action,
            subject,
            before,
            after,
            previous_sha256,
            sha256,
        }
    }
}

/// What has been done by whom, the latest first
#[utoipa::path(get, path = "/v1/audit", tag = "access", params(Query),
    responses((status = 200, body = Listing<EntryView>)))]
async fn list(
    State(app): State<App>,
    Params(query): Params<Query>,
) -> Result<Json<Listing<EntryView>>> {
    let filter = match (&query.actor, &query.subject) {
        (Some(_), Some(_)) => {
            let message = "give either an actor or a subject";
            let fault = Fault::at("subject", message);
            return Err(Problem::bad_request(format!("subject: {message}")).with(fault));
        }
        (Some(actor), None) => AuditFilter::Actor(actor),
        (None, Some(subject)) => AuditFilter::Subject(subject),
        (None, None) => AuditFilter::All,
    };
    let page = page::page(query.limit, query.after.as_ref())?;
    let entries = app.store().audit().list(filter, &page).await?;
    Ok(Json(Listing::of(entries, EntryView::of)))
}

/// The number and the hash of the last entry of the audit
#[utoipa::path(get, path = "/v1/audit/head", tag = "access",
    responses((status = 200, body = HeadView)))]
async fn head(State(app): State<App>) -> Result<Json<HeadView>> {
    let head = app.store().audit().head().await?;
    Ok(Json(HeadView { number: head.number, sha256: head.sha256 }))
}

/// Settings that hold for every process on the store
#[utoipa::path(get, path = "/v1/settings", tag = "access",
    responses((status = 200, body = Settings)))]
async fn settings(State(app): State<App>) -> Result<Json<Settings>> {
    Ok(Json(Settings { second_person: app.store().settings().second_person().await? }))
}

/// Change the settings
#[utoipa::path(
    put, path = "/v1/settings", tag = "access", request_body = Settings,
    responses((status = 200, body = Settings))
)]
async fn set_settings(State(app): State<App>, payload: Payload) -> Result<Json<Settings>> {
    let asked: Settings = payload.json()?;
    app.store().settings().set_second_person(asked.second_person).await?;
    Ok(Json(asked))
}
