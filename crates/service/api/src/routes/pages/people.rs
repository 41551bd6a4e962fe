//! Pages of users, keys and the audit, and signing in and out.

use std::sync::Arc;

use crate::accounts::{COOKIE, SESSION};
use axum::extract::{FromRequest as _, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use sistership_auth::Grant;
use sistership_pages::people::{Known, Offered};
use sistership_pages::{Fields, audit, people};
use sistership_store::{KeyRow, User};

use super::answer::{answer, own_place, then, with_cookie};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{Acting, Kind, current};
use crate::web::field::{KeyPrefix, UserName};
use crate::web::form::{PageForm, shell};
use crate::web::guard::origin_of;
use crate::web::{Params, Place};
use sistership_web_support::host;

type Asked = Params<Vec<(String, String)>>;

/// One day, µs.
const DAY: i64 = 86_400_000_000;

pub(super) async fn sign_in(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let query = Fields::from(query);
    sign_in_page(&app, own_place(query.text("next")), None)
}

/// Begins a session. The form has no session whose token it could send, so the browser must state
/// that the form is of this server: another site must not sign anybody in under another name.
pub(super) async fn signed_in(State(app): State<App>, request: Request) -> Result<Response> {
    let addressed = host::addressed(&request)?;
    if !host::is_same_origin(request.headers(), addressed.as_ref())? {
        let why = "sign in on the page of this server; the browser says that another site asks";
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    let from = origin_of(request.extensions());
    let secure = is_secure(request.headers());
    let PageForm(form) = PageForm::from_request(request, &app).await?;
    let (name, password) = (form.needed("name")?, form.needed("password")?);
    let next = own_place(form.text("next"));
    // The request has no caller yet: the audit names the user who signs in.
    let actor = sistership_store::Actor::new(name, from.as_str());
    match actor.acting(app.accounts().sign_in(name, password, &from)).await {
        Ok(secret) => Ok(with_session(then(next), &secret, secure)),
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
    let provider = title.map(|title| Offered { title, place: &place });
    Ok(answer(people::sign_in(shell(app), next, why_not, provider)?))
}

/// Adds the cookie of a new session; `secure` if the browser's connection uses TLS.
pub(super) fn with_session(response: Response, secret: &str, secure: bool) -> Response {
    let (age, secure) = (SESSION.as_secs(), if secure { "; Secure" } else { "" });
    with_cookie(response, &format!("{COOKIE}={secret}; Max-Age={age}; Path=/{secure}"))
}

/// Returns true if the browser's connection uses TLS, so that its cookie is kept from connections
/// without.
fn is_secure(headers: &HeaderMap) -> bool {
    let origin = headers.get(header::ORIGIN).and_then(|value| value.to_str().ok());
    origin.is_some_and(|origin| origin.starts_with("https://"))
}

pub(super) async fn sign_out(State(app): State<App>, PageForm(_): PageForm) -> Result<Response> {
    // Keys have no session to end; the cookie is removed in any case.
    if let Kind::Session { sha256, .. } = &who()?.principal.kind {
        app.store().sessions().end(sha256).await?;
        app.accounts().forget();
    }
    Ok(with_cookie(then("/sign-in"), &format!("{COOKIE}=; Max-Age=0; Path=/")))
}

pub(super) fn who() -> Result<Acting> {
    current().ok_or_else(|| Problem::internal("nobody is named who asks"))
}

pub(super) async fn account(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let principal = Arc::clone(&who()?.principal);
    let roles = principal.rights.grants().iter().map(ToString::to_string).collect();
    let notice = match Fields::from(query).text("done") {
        Some("password") => Some("The password is changed; sign in again wherever else you were."),
        Some("link") => Some("Your account is linked."),
        _ => None,
    };
    let identities = app.store().identities().of(&principal.name).await?;
    let provider = app.credentials().provider().map(|provider| provider.settings().title());
    let known = Known { identities, provider };
    Ok(answer(people::account(shell(&app), &principal.name, roles, known, notice)?))
}

/// Changes the user's own password, which ends all sessions, and begins a new one here.
pub(super) async fn password(
    State(app): State<App>,
    headers: HeaderMap,
    PageForm(form): PageForm,
) -> Result<Response> {
    let Acting { principal, origin } = who()?;
    if !matches!(principal.kind, Kind::Session { .. }) {
        return Err(Problem::invalid("old", "only who has signed in has a password"));
    }
    let (old, new) = (form.needed("old")?, form.needed("new")?);
    // A session alone must not be enough to change the password.
    app.accounts().verified(&principal.name, old, &origin).await.map_err(
        |problem| match problem.status() {
            StatusCode::UNAUTHORIZED => Problem::invalid("old", "is not your password"),
            _ => problem,
        },
    )?;
    app.accounts().set_password(&principal.name, new).await?;
    let secret = app.accounts().sign_in(&principal.name, new, &origin).await?;
    Ok(with_session(then("/account?done=password"), &secret, is_secure(&headers)))
}

pub(super) async fn users(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    Ok(answer(people::users(app.archive(), shell(&app), &Fields::from(query)).await?))
}

/// Parses roles that a person has written, separated by spaces.
fn roles(form: &Fields) -> Result<Vec<Grant>> {
    let words = form.text("roles").unwrap_or_default().split_whitespace();
    let read = |word: &str| word.parse().map_err(|message| Problem::invalid("roles", message));
    words.map(read).collect()
}

pub(super) async fn create(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let name = form.needed("name")?;
    let title = form.text("title").unwrap_or(name);
    app.accounts().create_user(name, title, Some(form.needed("password")?), &roles(&form)?).await?;
    Ok(then("/users"))
}

pub(super) async fn set_roles(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.accounts().set_roles(&User::principal(&name), &roles(&form)?).await?;
    Ok(then("/users"))
}

pub(super) async fn set_password(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.accounts().set_password(&name, form.needed("password")?).await?;
    Ok(then("/users"))
}

pub(super) async fn disable(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().enable(&name, false).await?;
    Ok(then("/users"))
}

pub(super) async fn enable(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().enable(&name, true).await?;
    Ok(then("/users"))
}

/// Creates a key, and shows it: no other page ever does.
pub(super) async fn make_key(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let days = form.text("days").map(|_| form.whole("days")).transpose()?;
    // Saturating, as the number of days comes from a person.
    let expires_us = days.map(|days| app.store().now_us().saturating_add(days.saturating_mul(DAY)));
    let (title, user) = (form.needed("title")?, form.text("user").map(str::to_owned));
    let (key, row) = app.accounts().make_key(title, user, expires_us, &roles(&form)?).await?;
    let KeyRow { title, .. } = row;
    let mut shown = answer(people::new_key(shell(&app), &title, key.as_str())?);
    // Neither the browser nor a proxy may store the key.
    shown.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    Ok(shown)
}

pub(super) async fn revoke(
    State(app): State<App>,
    Place(prefix): Place<KeyPrefix>,
    PageForm(_): PageForm,
) -> Result<Response> {
    app.accounts().revoke(&prefix).await?;
    Ok(then("/users"))
}

pub(super) async fn settings(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let on = form.needed("second_person")? == "on";
    app.store().settings().set_second_person(on).await?;
    Ok(then("/users"))
}

pub(super) async fn audit(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    Ok(answer(audit::page(app.archive(), shell(&app), &Fields::from(query)).await?))
}
