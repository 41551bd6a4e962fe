//! Sign-in at an OpenID provider, and linking of an account with it.

use crate::accounts::{SignInOutcome, find_cookie};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use sistership_auth::openid::{LIFETIME_S, SignInPurpose};
use sistership_pages::people::ProviderLink;
use sistership_pages::{FormFields, people, say};

use super::answer::{local_path, page_response, redirect_to, with_cookie};
use super::people::{current_caller, sign_in_page, with_session};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{AuthenticationKind, RequestActor};
use crate::web::QueryParams;
use crate::web::form::{PageForm, page_shell};
use crate::web::guard::origin_of;

/// Cookie of a sign-in in progress.
const TICKET_COOKIE: &str = "sistership_oidc";

/// Redirects to the provider.
pub(super) async fn begin_sign_in(
    State(app): State<App>,
    QueryParams(query): QueryParams<Vec<(String, String)>>,
) -> Result<Response> {
    let query = FormFields::from(query);
    let next = local_path(query.get_text("next"));
    match app.accounts().begin_at_provider(SignInPurpose::SignIn, next).await {
        Ok(begun) => Ok(with_ticket(&app, redirect_to(&begun.place), &begun.ticket, LIFETIME_S)),
        Err(problem) => failure_page(&app, next, problem),
    }
}

/// Receives the browser from the provider.
pub(super) async fn finish_sign_in(State(app): State<App>, request: Request) -> Response {
    let (parts, _) = request.into_parts();
    let from = origin_of(&parts.extensions);
    let (ticket, query) =
        (find_cookie(&parts.headers, TICKET_COOKIE), parts.uri.query().unwrap_or_default());
    let done = app.accounts().finish_at_provider(ticket, query, &parts.headers, &from).await;
    let response = match done {
        Ok(SignInOutcome::SignedIn { secret, next }) => {
            with_session(redirect_to(local_path(Some(&next))), &secret, uses_https(&app))
        }
        Ok(SignInOutcome::Linked) => redirect_to("/account?done=link"),
        Err(problem) => {
            failure_page(&app, "/", problem).unwrap_or_else(IntoResponse::into_response)
        }
    };
    // The ticket has served its purpose: its cookie is removed, also after a refusal or a failure.
    with_ticket(&app, response, "", 0)
}

/// Begins to link the user's own account with the provider.
pub(super) async fn link_account(
    State(app): State<App>,
    PageForm(_): PageForm,
) -> Result<Response> {
    let RequestActor { principal, .. } = current_caller()?;
    if !matches!(principal.kind, AuthenticationKind::Session { .. }) {
        return Err(Problem::invalid("identity", say("account-sign-in-to-link")));
    }
    let purpose = SignInPurpose::Link(principal.name.clone());
    let begun = app.accounts().begin_at_provider(purpose, "/account").await?;
    let title = app.credentials().provider().map(|provider| provider.settings().title());
    let provider = ProviderLink { title: title.unwrap_or_default(), place: &begun.place };
    let page = page_response(people::leave_page(page_shell(&app), provider)?);
    Ok(with_ticket(&app, page, &begun.ticket, LIFETIME_S))
}

/// Returns the sign-in page with the error; a failure of this server is an error of the request
/// instead.
fn failure_page(app: &App, next: &str, problem: Problem) -> Result<Response> {
    match problem.status() {
        StatusCode::INTERNAL_SERVER_ERROR | StatusCode::NOT_FOUND => Err(problem),
        _ => sign_in_page(app, next, Some(&problem.detail)),
    }
}

fn uses_https(app: &App) -> bool {
    app.credentials().provider().is_some_and(|provider| provider.settings().is_secure())
}

fn with_ticket(app: &App, response: Response, ticket: &str, age_s: i64) -> Response {
    let secure = if uses_https(app) { "; Secure" } else { "" };
    let cookie = format!("{TICKET_COOKIE}={ticket}; Max-Age={age_s}; Path=/sign-in/oidc{secure}");
    with_cookie(response, &cookie)
}
