//! Pages of users, keys and the audit, and how people sign in and out.

use std::sync::Arc;

use axum::extract::{FromRequest as _, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use sistership_access::Grant;
use sistership_pages::{Fields, audit, people};
use sistership_store::{KeyRow, User};

use super::answer::{answer, then};
use crate::accounts::{self, SESSION};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{Acting, COOKIE, Kind, current};
use crate::web::field::{KeyPrefix, UserName};
use crate::web::form::{PageForm, shell};
use crate::web::{Params, Place};
use sistership_http::host;
use sistership_listen::Peer;

type Asked = Params<Vec<(String, String)>>;

/// A day, µs.
const DAY: i64 = 86_400_000_000;

pub(super) async fn sign_in(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let query = Fields::from(query);
    Ok(answer(people::sign_in(shell(&app), own_place(query.text("next")), None)?))
}

/// Begins a session. The form has no session whose token it could send, so the browser must say that
/// it is of this server: nobody is to be signed in by another site under another name.
pub(super) async fn signed_in(State(app): State<App>, request: Request) -> Result<Response> {
    let addressed = host::addressed(&request)?;
    if !host::is_same_origin(request.headers(), addressed.as_ref())? {
        let why = "sign in on the page of this server; the browser says that another site asks";
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    let from = request.extensions().get::<Peer>().map(|peer| peer.party.to_string());
    let from = from.unwrap_or_else(|| "unknown".to_owned());
    let secure = is_secure(request.headers());
    let PageForm(form) = PageForm::from_request(request, &app).await?;
    let (name, password) = (form.needed("name")?, form.needed("password")?);
    let next = own_place(form.text("next"));
    let actor = sistership_store::Actor::new(name, from.as_str());
    match actor.acting(accounts::sign_in(&app, name, password, &from)).await {
        Ok(secret) => {
            let age = SESSION.as_secs();
            Ok(with_cookie(then(next), &format!("{secret}; Max-Age={age}{secure}")))
        }
        Err(problem) if problem.status() == StatusCode::UNAUTHORIZED => {
            let page = people::sign_in(shell(&app), next, Some(&problem.detail))?;
            Ok(answer(page))
        }
        Err(problem) => Err(problem),
    }
}

/// A place of this server to go to; its front page where another is named.
fn own_place(next: Option<&str>) -> &str {
    let own = |next: &&str| next.starts_with('/') && !next[1..].starts_with(['/', '\\']);
    next.filter(own).unwrap_or("/")
}

/// What keeps the cookie from connections without TLS, where the browser itself has one.
fn is_secure(headers: &HeaderMap) -> &'static str {
    let origin = headers.get(header::ORIGIN).and_then(|value| value.to_str().ok());
    if origin.is_some_and(|origin| origin.starts_with("https://")) { "; Secure" } else { "" }
}

fn with_cookie(mut response: Response, value: &str) -> Response {
    let cookie = format!("{COOKIE}={value}; Path=/; HttpOnly; SameSite=Lax");
    if let Ok(cookie) = HeaderValue::try_from(cookie) {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

pub(super) async fn sign_out(State(app): State<App>, PageForm(_): PageForm) -> Result<Response> {
    if let Kind::Session { sha256, .. } = &who()?.principal.kind {
        app.store().sessions().end(sha256).await?;
        app.known().forget();
    }
    Ok(with_cookie(then("/sign-in"), "; Max-Age=0"))
}

fn who() -> Result<Acting> {
    current().ok_or_else(|| Problem::internal("nobody is named who asks"))
}

pub(super) async fn account(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let principal = Arc::clone(&who()?.principal);
    let roles = principal.rights.grants().iter().map(ToString::to_string).collect();
    let changed = Fields::from(query).text("changed").is_some();
    Ok(answer(people::account(shell(&app), &principal.name, roles, changed)?))
}

/// Changes one's own password, which signs out everywhere, and in here again.
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
    accounts::verified(&app, &principal.name, old, &origin).await.map_err(
        |problem| match problem.status() {
            StatusCode::UNAUTHORIZED => Problem::invalid("old", "is not your password"),
            _ => problem,
        },
    )?;
    accounts::set_password(&app, &principal.name, new).await?;
    let secret = accounts::sign_in(&app, &principal.name, new, &origin).await?;
    let (age, secure) = (SESSION.as_secs(), is_secure(&headers));
    let done = then("/account?changed=yes");
    Ok(with_cookie(done, &format!("{secret}; Max-Age={age}{secure}")))
}

pub(super) async fn users(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    Ok(answer(people::users(app.archive(), shell(&app), &Fields::from(query)).await?))
}

/// Roles as a person writes them, with spaces between.
fn roles(form: &Fields) -> Result<Vec<Grant>> {
    let words = form.text("roles").unwrap_or_default().split_whitespace();
    let read = |word: &str| word.parse().map_err(|message| Problem::invalid("roles", message));
    words.map(read).collect()
}

pub(super) async fn create(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let name = form.needed("name")?;
    let title = form.text("title").unwrap_or(name);
    accounts::create_user(&app, name, title, Some(form.needed("password")?), &roles(&form)?)
        .await?;
    Ok(then("/users"))
}

pub(super) async fn set_roles(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    accounts::set_roles(&app, &User::principal(&name), &roles(&form)?).await?;
    Ok(then("/users"))
}

pub(super) async fn set_password(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(form): PageForm,
) -> Result<Response> {
    accounts::set_password(&app, &name, form.needed("password")?).await?;
    Ok(then("/users"))
}

pub(super) async fn disable(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    accounts::enable(&app, &name, false).await?;
    Ok(then("/users"))
}

pub(super) async fn enable(
    State(app): State<App>,
    Place(name): Place<UserName>,
    PageForm(_): PageForm,
) -> Result<Response> {
    accounts::enable(&app, &name, true).await?;
    Ok(then("/users"))
}

/// Makes a key, and shows it: the only page that ever does.
pub(super) async fn make_key(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let days = form.text("days").map(|_| form.whole("days")).transpose()?;
    let expires_us = days.map(|days| app.store().now_us().saturating_add(days.saturating_mul(DAY)));
    let (title, user) = (form.needed("title")?, form.text("user").map(str::to_owned));
    let (key, row) = accounts::make_key(&app, title, user, expires_us, &roles(&form)?).await?;
    let KeyRow { title, .. } = row;
    let mut shown = answer(people::new_key(shell(&app), &title, key.as_str())?);
    shown.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    Ok(shown)
}

pub(super) async fn revoke(
    State(app): State<App>,
    Place(prefix): Place<KeyPrefix>,
    PageForm(_): PageForm,
) -> Result<Response> {
    accounts::revoke(&app, &prefix).await?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_sent_elsewhere() {
        assert_eq!(own_place(Some("/ships/kcs?a=b")), "/ships/kcs?a=b");
        for other in ["//evil.example", "/\\evil.example", "https://evil.example", "", "ships"] {
            assert_eq!(own_place(Some(other)), "/", "{other}");
        }
        assert_eq!(own_place(None), "/");
    }
}
