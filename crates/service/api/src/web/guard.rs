//! Access control: a caller identifies itself, or is, on a loopback interface without a key, a
//! program of the same machine; then its roles decide.

use std::net::IpAddr;

use axum::RequestExt as _;
use axum::extract::{MatchedPath, RawPathParams, Request, State};
use axum::http::{Extensions, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Redirect, Response};

use crate::accounts::IdentityRefusal;
use crate::app::App;
use crate::problem::Problem;
use crate::rights::{HEALTH_ROUTES, OPEN_ROUTES, RequestActor, RightsRequest, check_access};
use sistership_listener::PeerInfo;
use sistership_web_support::host;

/// Time after which a refused client may try again, seconds.
const RETRY_AFTER_S: u64 = 2;

/// Lets a request through, or answers what it lacks.
pub(crate) async fn guard_request(
    State(app): State<App>,
    mut request: Request,
    next: Next,
) -> Response {
    let peer = request.extensions().get::<PeerInfo>().cloned();
    if let Some(peer) = &peer {
        let client = app.proxies().client_address(peer.address, request.headers());
        // Before any refusal: throttling and the audit need the client's address.
        request.extensions_mut().insert(ClientAddress(client));
    }
    if peer.as_ref().is_some_and(|peer| peer.crowded) {
        let why = "all connections, or all that one address may have, are in use; try again in a \
                   moment";
        return retry_later(Problem::new(StatusCode::SERVICE_UNAVAILABLE, why), RETRY_AFTER_S);
    }
    match admit(&app, &mut request).await {
        Ok(Some(acting)) => acting.run_scoped(next.run(request)).await,
        Ok(None) => next.run(request).await,
        Err(IdentityRefusal::Problem(problem)) => refusal_response(&app, &request, problem),
        Err(IdentityRefusal::WrongKey(problem)) => {
            let client = request.extensions().get::<ClientAddress>();
            match client.and_then(|client| app.throttle().record_wrong(client.0)) {
                Some(wait) => {
                    let why = "too many wrong API keys from your address; check the key, and try \
                        again later";
                    retry_later(
                        Problem::new(StatusCode::TOO_MANY_REQUESTS, why),
                        wait.as_secs().max(1),
                    )
                }
                None => problem.into_response(),
            }
        }
    }
}

/// Answer of a refusal; a browser that asks for a page is sent to sign in first.
fn refusal_response(app: &App, request: &Request, problem: Problem) -> Response {
    let accepted = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let page = request.method() == Method::GET
        && !request.uri().path().starts_with("/v1")
        && accepted.is_some_and(|accepted| accepted.contains("text/html"));
    if problem.status != StatusCode::UNAUTHORIZED.as_u16()
        || !page
        || !app.credentials().has_people()
    {
        return problem.into_response();
    }
    let place = request.uri().path_and_query().map_or("/", |place| place.as_str());
    let asked = [("next", place)];
    let query = serde_urlencoded::to_string(asked).unwrap_or_default();
    Redirect::to(&format!("/sign-in?{query}")).into_response()
}

/// Refusal that closes the connection and says when to try again.
fn retry_later(problem: Problem, seconds: u64) -> Response {
    let mut response = problem.into_response();
    response.headers_mut().insert(header::RETRY_AFTER, seconds.into());
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    response
}

/// Returns the caller of a request that is let through; `None` for routes without identification.
async fn admit(app: &App, request: &mut Request) -> Result<Option<RequestActor>, IdentityRefusal> {
    let host = host::request_authority(request)?;
    let place = (method_name(request.method()), request.uri().path());
    if HEALTH_ROUTES.contains(&place) {
        return Ok(None);
    }
    // Without a key the loopback interface is the only protection: a web page in a browser of this
    // machine must not pass for a local program.
    if app.credentials().is_open() {
        host::check_local_origin(request.method(), request.headers(), host.as_ref())?;
    }
    if OPEN_ROUTES.contains(&place) {
        return Ok(None);
    }
    // A request of a page of this server; its forms carry a token besides.
    let own = !request.uri().path().starts_with("/v1")
        && host::is_same_origin(request.headers(), host.as_ref())?;
    let principal = app.accounts().identify(request.method(), request.headers(), own).await?;
    let origin = origin_of(request.extensions());
    let acting = RequestActor { principal, origin };
    let params = request.extract_parts::<RawPathParams>().await;
    let params = params.map_err(|error| Problem::not_found(error.body_text()))?;
    let route = request.extensions().get::<MatchedPath>().cloned();
    let asked = RightsRequest {
        method: request.method(),
        uri: request.uri(),
        route: route.as_ref().map(MatchedPath::as_str),
        params: &params,
    };
    check_access(app, &acting, &asked).await?;
    Ok(Some(acting))
}

fn method_name(method: &Method) -> &str {
    if *method == Method::HEAD { "GET" } else { method.as_str() }
}

/// Address of the caller: the other end of the connection, or the address that a trusted proxy
/// states.
#[derive(Debug, Clone, Copy)]
struct ClientAddress(IpAddr);

/// Origin of a request, as the audit records it.
pub(crate) fn origin_of(extensions: &Extensions) -> String {
    let client = extensions.get::<ClientAddress>();
    client.map_or_else(|| "unknown".to_owned(), |client| client.0.to_string())
}
