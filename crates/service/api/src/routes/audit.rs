//! The audit log, and the settings whose changes it records.

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
use crate::web::field::{AuditName, Cursor, Limit, WebAddress};
use crate::web::{DocumentBody, Listing, QueryParams, page};

pub(super) fn audit_routes() -> OpenApiRouter<App> {
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
    /// Author: a user, `key:PREFIX`, `server-key`, `local`, `command-line` or `sistership` itself.
    actor: String,
    /// Origin: an address, a job, a process.
    origin: String,
    /// Action, such as `alias.move`.
    action: String,
    /// Subject, such as `ship:kvlcc2`.
    subject: String,
    /// State of the subject before; null if it did not exist.
    #[schema(value_type = Option<Object>)]
    before: Option<Value>,
    /// State of the subject after; null if it no longer exists.
    #[schema(value_type = Option<Object>)]
    after: Option<Value>,
    /// Hash of the protected columns of the subject after the change; null for subjects without.
    row_sha256: Option<String>,
    /// Hash of the previous entry; empty for the first.
    previous_sha256: String,
    /// Hash of this entry and of the previous one.
    sha256: String,
}

/// The last entry of the audit.
#[derive(Debug, Serialize, ToSchema)]
struct HeadView {
    /// Its number; 0 if the audit is empty.
    number: i64,
    /// Its hash. A copy kept elsewhere proves later that no earlier entry was rewritten.
    sha256: String,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct AuditQuery {
    /// Only entries by this author.
    #[param(inline)]
    actor: Option<AuditName>,
    /// Only entries about this subject.
    #[param(inline)]
    subject: Option<AuditName>,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

/// Settings that apply to every process on the store.
#[derive(Debug, Serialize, ToSchema)]
struct Settings {
    /// True if a version becomes champion only by an approver who has not made it.
    second_person: bool,
    /// Address of this server for links in messages; null for none.
    public_url: Option<String>,
}

/// Settings that replace all others.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct SettingsRequest {
    /// True if a version becomes champion only by an approver who has not made it.
    second_person: bool,
    /// Address of this server as people open it, for links in messages; by default none.
    #[schema(inline)]
    public_url: Option<WebAddress>,
}

impl Settings {
    async fn load(app: &App) -> Result<Self> {
        let settings = app.store().settings();
        let second_person = settings.requires_second_person().await?;
        Ok(Self { second_person, public_url: settings.public_url().await? })
    }
}

impl EntryView {
    fn from_entry(entry: AuditEntry) -> Self {
        let AuditEntry { number, at_us, actor, origin, action, subject, .. } = entry;
        // States are stored as JSON; one that cannot be parsed is shown as null.
        let read = |text: Option<String>| text.and_then(|text| serde_json::from_str(&text).ok());
        let (before, after) = (read(entry.state_before), read(entry.state_after));
        let row_sha256 = entry.row_sha256;
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
            row_sha256,
            previous_sha256,
            sha256,
        }
    }
}

/// List the entries of the audit, the latest first
#[utoipa::path(get, path = "/v1/audit", tag = "access", params(AuditQuery),
    responses((status = 200, body = Listing<EntryView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<AuditQuery>,
) -> Result<Json<Listing<EntryView>>> {
    // The store filters by one of the two only.
    let filter = match (&query.actor, &query.subject) {
        (Some(_), Some(_)) => {
            let message = "give either an actor or a subject";
            let fault = Fault::at_field("subject", message);
            return Err(Problem::bad_request(format!("subject: {message}")).with_fault(fault));
        }
        (Some(actor), None) => AuditFilter::Actor(actor),
        (None, Some(subject)) => AuditFilter::Subject(subject),
        (None, None) => AuditFilter::All,
    };
    let page = page::parse_page(query.limit, query.after.as_ref())?;
    let entries = app.store().audit().list(filter, &page).await?;
    Ok(Json(Listing::from_list(entries, EntryView::from_entry)))
}

/// Get the number and the hash of the last entry of the audit
#[utoipa::path(get, path = "/v1/audit/head", tag = "access",
    responses((status = 200, body = HeadView)))]
async fn head(State(app): State<App>) -> Result<Json<HeadView>> {
    let head = app.store().audit().chain_head().await?;
    Ok(Json(HeadView { number: head.number, sha256: head.sha256 }))
}

/// Get the settings that apply to every process on the store
#[utoipa::path(get, path = "/v1/settings", tag = "access",
    responses((status = 200, body = Settings)))]
async fn settings(State(app): State<App>) -> Result<Json<Settings>> {
    Ok(Json(Settings::load(&app).await?))
}

/// Change the settings
#[utoipa::path(
    put, path = "/v1/settings", tag = "access", request_body = SettingsRequest,
    responses((status = 200, body = Settings))
)]
async fn set_settings(State(app): State<App>, payload: DocumentBody) -> Result<Json<Settings>> {
    let SettingsRequest { second_person, public_url } = payload.parse_json()?;
    let settings = app.store().settings();
    settings.set_second_person(second_person).await?;
    settings.set_public_url(public_url.as_deref().unwrap_or_default()).await?;
    Ok(Json(Settings::load(&app).await?))
}
