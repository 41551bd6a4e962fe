//! Pages of users, keys and the audit, and signing in and out.

use std::sync::Arc;

use crate::accounts::{SESSION_COOKIE, SESSION_LIFETIME};
use axum::extract::{FromRequest as _, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use sistership_auth::Grant;
use sistership_jobs::webhooks::MessageFormat;
use sistership_pages::people::{LinkedIdentities, ProviderLink};
use sistership_pages::{FormFields, audit, people, say};
use sistership_store::{KeyRow, User};

use super::super::webhooks;
use super::answer::{local_path, page_response, redirect_to, with_cookie};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{AuthenticationKind, RequestActor, current_actor};
use crate::web::field::{KeyPrefix, UserName, WebAddress};
use crate::web::form::{PageForm, page_shell};
use crate::web::guard::origin_of;
use crate::web::{Id, PathParams, QueryParams};
use sistership_web_support::host;

type PageQuery = QueryParams<Vec<(String, String)>>;

/// One day, µs.
const DAY_US: i64 = 86_400_000_000;

pub(super) async fn sign_in_form(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    let query = FormFields::from(query);
    sign_in_page(&app, local_path(query.get_text("next")), None)
}

/// Begins a session. The form has no session whose token it could send, so the browser must state
/// that the form is of this server: another site must not sign anybody in under another name.
pub(super) async fn sign_in_user(State(app): State<App>, request: Request) -> Result<Response> {
    let addressed = host::request_authority(&request)?;
    if !host::is_same_origin(request.headers(), addressed.as_ref())? {
        let why = say("sign-in-other-site");
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    let from = origin_of(request.extensions());
    let secure = is_https(request.headers());
    let PageForm(form) = PageForm::from_request(request, &app).await?;
    let (name, password) = (form.required_text("name")?, form.required_text("password")?);
    let next = local_path(form.get_text("next"));
    // The request has no caller yet: the audit names the user who signs in.
    let actor = sistership_store::Actor::new(name, from.as_str());
    match actor.run_scoped(app.accounts().sign_in(name, password, &from)).await {
        Ok(secret) => Ok(with_session(redirect_to(next), &secret, secure)),
        Err(problem) if problem.status() == StatusCode::UNAUTHORIZED => {
            sign_in_page(&app, next, Some(&problem.detail))
        }
        Err(problem) => Err(problem),
    }
}

/// Returns the sign-in page, with the error of the last attempt.
pub(super) fn sign_in_page(app: &App, next: &str, why_not: Option<&str>) -> Result<Response> {
    let place = serde_urlencoded::to_string([("next", next)]).unwrap_or_default();
    let place = format!("/sign-in/oidc?{place}");
    let title = app.credentials().provider().map(|provider| provider.settings().title());
    let provider = title.map(|title| ProviderLink { title, place: &place });
    Ok(page_response(people::sign_in_page(page_shell(app), next, why_not, provider)?))
}

/// Adds the cookie of a new session; `secure` if the browser's connection uses TLS.
pub(super) fn with_session(response: Response, secret: &str, secure: bool) -> Response {
    let (age, secure) = (SESSION_LIFETIME.as_secs(), if secure { "; Secure" } else { "" });
    with_cookie(response, &format!("{SESSION_COOKIE}={secret}; Max-Age={age}; Path=/{secure}"))
}

/// Returns true if the browser's connection uses TLS, so that its cookie is kept from connections
/// without.
fn is_https(headers: &HeaderMap) -> bool {
    let origin = headers.get(header::ORIGIN).and_then(|value| value.to_str().ok());
    origin.is_some_and(|origin| origin.starts_with("https://"))
}

pub(super) async fn sign_out(State(app): State<App>, PageForm(_): PageForm) -> Result<Response> {
    // Keys have no session to end; the cookie is removed in any case.
    if let AuthenticationKind::Session { sha256, .. } = &current_caller()?.principal.kind {
        app.store().sessions().end_session(sha256).await?;
        app.accounts().clear_cache();
    }
    Ok(with_cookie(redirect_to("/sign-in"), &format!("{SESSION_COOKIE}=; Max-Age=0; Path=/")))
}

pub(super) fn current_caller() -> Result<RequestActor> {
    current_actor()
        .ok_or_else(|| Problem::internal("the request has no user or key; sign in, or send a key"))
}

pub(super) async fn account_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    let principal = Arc::clone(&current_caller()?.principal);
    let roles = principal.rights.grants().iter().map(ToString::to_string).collect();
    let notice = match FormFields::from(query).get_text("done") {
        Some("password") => Some(say("account-password-changed").to_string()),
        Some("link") => Some(say("account-linked").to_string()),
        _ => None,
    };
    let identities = app.store().identities().list_by_user(&principal.name).await?;
    let provider = app.credentials().provider().map(|provider| provider.settings().title());
    let known = LinkedIdentities { identities, provider };
    Ok(page_response(people::account_page(
        page_shell(&app),
        &principal.name,
        roles,
        known,
        notice.as_deref(),
    )?))
}

/// Changes the user's own password, which ends all sessions, and begins a new one here.
pub(super) async fn change_password(
    State(app): State<App>,
    headers: HeaderMap,
    PageForm(form): PageForm,
) -> Result<Response> {
    let RequestActor { principal, origin } = current_caller()?;
    if !matches!(principal.kind, AuthenticationKind::Session { .. }) {
        return Err(Problem::invalid("old", say("account-sign-in-first")));
    }
    let (old, new) = (form.required_text("old")?, form.required_text("new")?);
    // A session alone must not be enough to change the password.
    app.accounts().verify_password_of(&principal.name, old, &origin).await.map_err(|problem| {
        match problem.status() {
            StatusCode::UNAUTHORIZED => Problem::invalid("old", say("account-wrong-password")),
            _ => problem,
        }
    })?;
    app.accounts().set_password(&principal.name, new).await?;
    let secret = app.accounts().sign_in(&principal.name, new, &origin).await?;
    Ok(with_session(redirect_to("/account?done=password"), &secret, is_https(&headers)))
}

pub(super) async fn users_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    Ok(page_response(
        people::users_page(app.archive(), page_shell(&app), &FormFields::from(query)).await?,
    ))
}

/// Parses the roles that a form keeps, and the one that it adds: a role, and the ship or family for
/// which it is given.
fn parse_roles(form: &FormFields) -> Result<Vec<Grant>> {
    let kept = form.get_texts("roles").flat_map(str::split_whitespace).map(str::to_owned);
    let added = match (form.get_text("role"), form.get_text("scope")) {
        (None, _) => None,
        (Some(role), None) => Some(role.to_owned()),
        (Some(role), Some(kind)) => {
            Some(format!("{role}@{kind}:{}", form.required_text("scope_name")?))
        }
    };
    let read = |word: String| word.parse().map_err(|message| Problem::invalid("roles", message));
    kept.chain(added).map(read).collect()
}

pub(super) async fn create_user(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let name = form.required_text("name")?;
    let title = form.get_text("title").unwrap_or(name);
    app.accounts()
        .create_user(name, title, Some(form.required_text("password")?), &parse_roles(&form)?)
        .await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn set_roles(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.accounts().set_roles(&User::principal_name(&name), &parse_roles(&form)?).await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn set_password(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.accounts().set_password(&name, form.required_text("password")?).await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn disable_user(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().set_enabled(&name, false).await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn enable_user(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().set_enabled(&name, true).await?;
    Ok(redirect_to("/users"))
}

/// Creates a key, and shows it: no other page ever does.
pub(super) async fn make_key(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let days = form.get_text("days").map(|_| form.whole_number("days")).transpose()?;
    // Saturating, as the number of days comes from a person.
    let expires_us =
        days.map(|days| app.store().now_us().saturating_add(days.saturating_mul(DAY_US)));
    let (title, user) = (form.required_text("title")?, form.get_text("user").map(str::to_owned));
    let (key, row) = app.accounts().make_key(title, user, expires_us, &parse_roles(&form)?).await?;
    let KeyRow { title, .. } = row;
    let mut shown = page_response(people::new_key_page(page_shell(&app), &title, key.as_str())?);
    // Neither the browser nor a proxy may store the key.
    shown.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    Ok(shown)
}

pub(super) async fn revoke_key(
    State(app): State<App>,
    PathParams(prefix): PathParams<KeyPrefix>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().revoke(&prefix).await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn change_settings(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let on = form.required_text("second_person")? == "on";
    app.store().settings().set_second_person(on).await?;
    Ok(redirect_to("/users"))
}

pub(super) async fn audit_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    Ok(page_response(
        audit::audit_page(app.archive(), page_shell(&app), &FormFields::from(query)).await?,
    ))
}

pub(super) async fn webhooks_page(State(app): State<App>) -> Result<Response> {
    Ok(page_response(
        people::webhooks_page(app.archive(), page_shell(&app), app.mail().is_some()).await?,
    ))
}

/// Creates a webhook, and shows its secret: no other page ever does.
pub(super) async fn make_webhook(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let (secret, webhook) =
        webhooks::create_from_page(&app, people::webhook_request(&form)?).await?;
    // A mail box checks no signature.
    if MessageFormat::from_url(&webhook.url) == MessageFormat::Mail {
        return Ok(redirect_to("/webhooks"));
    }
    let mut page =
        page_response(people::new_webhook_page(page_shell(&app), &webhook.title, &secret)?);
    page.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    Ok(page)
}

pub(super) async fn end_webhook(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.store().webhooks().end_webhook(&id).await?;
    Ok(redirect_to("/webhooks"))
}

/// Sets the address of the server for links in messages.
pub(super) async fn set_address(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let url = form.get_text("public_url").unwrap_or_default();
    if !url.is_empty() {
        url.parse::<WebAddress>().map_err(|message| Problem::invalid("public_url", message))?;
    }
    app.store().settings().set_public_url(url).await?;
    Ok(redirect_to("/webhooks"))
}
