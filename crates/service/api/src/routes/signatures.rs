//! Signatures under versions: who made, checked and approved one.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use sistership_store::{Actor, SignOff};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::aliases::check_second_person;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{PersonName, RequestKey};
use crate::web::{DocumentBody, IdempotencyKey, Name, Number, PathParams, StoredReply};

pub(super) fn signature_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list, sign))
}

/// Role in which a person signs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum SignatureRole {
    /// The person has checked the version.
    Checked,
    /// The person has approved it.
    Approved,
}

impl SignatureRole {
    /// Role in the audit, one of `sistership_store::SIGN_OFF_ROLES`.
    fn as_str(self) -> &'static str {
        match self {
            Self::Checked => "checked",
            Self::Approved => "approved",
        }
    }
}

/// A signature to be added.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SignatureRequest {
    role: SignatureRole,
    /// Name of the person as it is printed under the summary.
    #[schema(inline)]
    person: PersonName,
}

/// Signatures under a version.
#[derive(Debug, Serialize, ToSchema)]
struct SignatureList {
    /// Author of the version, as the audit names it.
    author: String,
    /// When the version was made.
    created_us: i64,
    /// The latest 100, the latest first; the first of each role counts.
    signatures: Vec<SignatureView>,
}

/// A signature.
#[derive(Debug, Serialize, ToSchema)]
struct SignatureView {
    /// `checked` or `approved`.
    role: String,
    person: String,
    /// Who sent it, as the audit names it.
    actor: String,
    at_us: i64,
}

/// The signature that was added.
#[derive(Debug, Serialize, ToSchema)]
struct SignatureReceipt<'a> {
    model: &'a str,
    number: i64,
    /// `checked` or `approved`.
    role: &'a str,
    person: &'a str,
}

impl SignatureView {
    fn from_sign_off(one: SignOff) -> Self {
        let SignOff { role, person, actor, at_us } = one;
        Self { role, person, actor, at_us }
    }
}

impl SignatureList {
    async fn load(app: &App, model: &str, number: i64) -> Result<Self> {
        let versions = app.store().versions();
        let head = versions.get_head(model, number).await?;
        let signed = versions.list_sign_offs(model, number).await?;
        Ok(Self {
            author: head.author,
            created_us: head.created_us,
            signatures: signed.into_iter().map(SignatureView::from_sign_off).collect(),
        })
    }
}

/// Get the signatures under a version
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}/signatures", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path)),
    responses((status = 200, body = SignatureList))
)]
async fn list(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
) -> Result<Json<SignatureList>> {
    Ok(Json(SignatureList::load(&app, &model, number.get()).await?))
}

/// Sign a version as checked or approved
///
/// Signatures are part of the audit and cannot be removed. Where a second person is required,
/// `approved` needs the role approver, and another person than the author.
#[utoipa::path(
    post, path = "/v1/models/{model}/versions/{number}/signatures", tag = "models",
    params(
        ("model" = inline(Name), Path), ("number" = inline(Number), Path),
        ("Idempotency-Key" = inline(Option<RequestKey>), Header,
        description = "Key that makes it safe to repeat the request"),
    ),
    request_body = SignatureRequest,
    responses((status = 201, body = SignatureReceipt))
)]
async fn sign(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let (asked, number): (SignatureRequest, i64) = (payload.parse_json()?, number.get());
    let work = move |app: App| async move {
        sign_version(&app, &model, number, &asked).await?;
        // The list has it once the transaction of the request is committed.
        let (role, person) = (asked.role.as_str(), &*asked.person);
        let receipt = SignatureReceipt { model: &model, number, role, person };
        StoredReply::new(StatusCode::CREATED, &receipt)
    };
    key.run_once(&app, payload.bytes(), work).await
}

/// Signs a version, as the endpoint and the page do.
pub(super) async fn sign_version(
    app: &App,
    model: &str,
    number: i64,
    asked: &SignatureRequest,
) -> Result<()> {
    // Every engineer may have checked a version; approval has consequences.
    if asked.role == SignatureRole::Approved {
        check_approver(app, model, number).await?;
    }
    let versions = app.store().versions();
    Ok(versions.sign_off(model, number, asked.role.as_str(), &asked.person).await?)
}

/// Checks that the caller may approve a version: where a second person is required, an approver who
/// has not made it.
async fn check_approver(app: &App, model: &str, number: i64) -> Result<()> {
    check_second_person(app.store(), model).await?;
    let required = app.store().settings().requires_second_person().await?;
    let author = app.store().versions().get_head(model, number).await?.author;
    // The author is that of the audit, not the name that is printed.
    match required && author == Actor::current().name {
        true => {
            Err(Problem::invalid("role", "another person approves a version that you have made"))
        }
        false => Ok(()),
    }
}
