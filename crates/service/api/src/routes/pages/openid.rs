//! Sign-in at an OpenID provider, and linking of an account with it.

use crate::accounts::{Outcome, cookie};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::response::Response;
use sistership_auth::openid::{LIFETIME_S, Purpose};
use sistership_pages::people::Offered;
use sistership_pages::{Fields, people};

use super::answer::{answer, own_place, then, with_cookie};
use super::people::{sign_in_page, who, with_session};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{Acting, Kind};
use crate::web::Params;
use crate::web::form::{PageForm, shell};
use crate::web::guard::origin_of;

/// Cookie of a sign-in in progress.
const TICKET: &str = "sistership_oidc";

/// Redirects to the provider.
pub(super) async fn begin(
    State(app): State<App>,
    Params(query): Params<Vec<(String, String)>>,
) -> Result<Response> {
    let query = Fields::from(query);
    let next = own_place(query.text("next"));
    match app.accounts().begin_at_provider(Purpose::SignIn, next).await {
        Ok(begun) => Ok(with_ticket(&app, then(&begun.place), &begun.ticket, LIFETIME_S)),
        Err(problem) => failed(&app, next, problem),
    }
}

/// Receives the browser from the provider.
pub(super) async fn callback(State(app): State<App>, request: Request) -> Result<Response> {
    let (parts, _) = request.into_parts();
    let from = origin_of(&parts.extensions);
    let (ticket, query) = (cookie(&parts.headers, TICKET), parts.uri.query().unwrap_or_default());
    let done = app.accounts().finish_at_provider(ticket, query, &parts.headers, &from).await;
    let response = match done {
        Ok(Outcome::SignedIn { secret, next }) => {
            with_session(then(own_place(Some(&next))), &secret, is_secure(&app))
        }
        Ok(Outcome::Linked) => then("/account?done=link"),
        Err(problem) => failed(&app, "/", problem)?,
    };
    // The ticket has served its purpose: its cookie is removed, also after a refusal.
    Ok(with_ticket(&app, response, "", 0))
}

/// Begins to link the user's own account with the provider.
pub(super) async fn link(State(app): State<App>, PageForm(_): PageForm) -> Result<Response> {
    let Acting { principal, .. } = who()?;
    if !matches!(principal.kind, Kind::Session { .. }) {
        return Err(Problem::invalid("identity", "only who has signed in has an account to link"));
    }
    let purpose = Purpose::Link(principal.name.clone());
    let begun = app.accounts().begin_at_provider(purpose, "/account").await?;
    let title = app.credentials().provider().map(|provider| provider.settings().title());
    let provider = Offered { title: title.unwrap_or_default(), place: &begun.place };
    let page = answer(people::leave(shell(&app), provider)?);
    Ok(with_ticket(&app, page, &begun.ticket, LIFETIME_S))
}

/// Returns the sign-in page with the error; a failure of this server is an error of the request
/// instead.
fn failed(app: &App, next: &str, problem: Problem) -> Result<Response> {
    match problem.status() {
        StatusCode::INTERNAL_SERVER_ERROR | StatusCode::NOT_FOUND => Err(problem),
        _ => sign_in_page(app, next, Some(&problem.detail)),
    }
}

fn is_secure(app: &App) -> bool {
    app.credentials().provider().is_some_and(|provider| provider.settings().is_secure())
}

fn with_ticket(app: &App, response: Response, ticket: &str, age_s: i64) -> Response {
    let secure = if is_secure(app) { "; Secure" } else { "" };
    let cookie = format!("{TICKET}={ticket}; Max-Age={age_s}; Path=/sign-in/oidc{secure}");
    with_cookie(response, &cookie)
}
