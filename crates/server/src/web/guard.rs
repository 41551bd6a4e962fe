//! Who may ask: the API key, or, on a machine's own interface without a key, programs of that
//! machine.

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;

use super::api_key::ApiKey;
use super::host;
use crate::app::App;
use crate::problem::Problem;
use sistership_listen::Peer;

/// Paths that tell nothing worth a key.
const OPEN: [&str; 3] = ["/healthz", "/readyz", "/openapi.json"];

/// How long who finds no seat should wait, seconds.
const RETRY: u64 = 2;

/// Lets a request through, or says what it lacks.
pub(crate) async fn guard(State(app): State<App>, request: Request, next: Next) -> Response {
    let peer = request.extensions().get::<Peer>();
    if peer.is_some_and(|peer| peer.crowded) {
        let why = "all connections are at work, or those of your address; try again in a moment";
        return later(Problem::new(StatusCode::SERVICE_UNAVAILABLE, why), RETRY);
    }
    match allowed(&app, &request) {
        Ok(()) => next.run(request).await,
        Err(Refusal::Problem(problem)) => problem.into_response(),
        Err(Refusal::WrongKey(problem)) => {
            match peer.and_then(|peer| app.throttle().wrong(peer.party)) {
                Some(wait) => {
                    let why = "too many wrong API keys from your address; check the key, and try again later";
                    later(Problem::new(StatusCode::TOO_MANY_REQUESTS, why), wait.as_secs().max(1))
                }
                None => problem.into_response(),
            }
        }
    }
}

/// A refusal that ends the connection and says when to come again.
fn later(problem: Problem, seconds: u64) -> Response {
    let mut response = problem.into_response();
    response.headers_mut().insert(header::RETRY_AFTER, seconds.into());
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    response
}

/// Why a request is not let through.
#[derive(Debug)]
enum Refusal {
    Problem(Problem),
    /// A key was presented, and is not the key.
    WrongKey(Problem),
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

fn allowed(app: &App, request: &Request) -> std::result::Result<(), Refusal> {
    let host = host::addressed(request)?;
    if OPEN.contains(&request.uri().path()) {
        return Ok(());
    }
    match app.key() {
        Some(key) => {
            // A form that a page of this server sends, which has a token besides.
            let own = !request.uri().path().starts_with("/v1")
                && host::is_same_origin(request.headers(), host.as_ref())?;
            authorised(key, request.method().is_safe() || own, request.headers())
        }
        None => Ok(host::from_this_machine(request.method(), request.headers(), host.as_ref())?),
    }
}

fn authorised(
    key: &ApiKey,
    by_browser: bool,
    headers: &HeaderMap,
) -> std::result::Result<(), Refusal> {
    let needed = || {
        Problem::new(
            StatusCode::UNAUTHORIZED,
            "send the header `Authorization: Bearer KEY` with the server's API key",
        )
    };
    let value = host::single(headers, &header::AUTHORIZATION)?.ok_or_else(needed)?;
    let (scheme, rest) = value.split_once(' ').ok_or_else(needed)?;
    let presented = match scheme.to_ascii_lowercase().as_str() {
        "bearer" => rest.trim().to_owned(),
        // Browsers send this by themselves, also on behalf of other sites: good enough to look, not
        // to change, unless the browser says that a page of this server asks.
        "basic" if by_browser => password(rest.trim()).ok_or_else(needed)?,
        _ => return Err(needed().into()),
    };
    if key.is(&presented) { Ok(()) } else { Err(Refusal::WrongKey(needed())) }
}

/// The password of `user:password` in Base64.
fn password(encoded: &str) -> Option<String> {
    let text = String::from_utf8(BASE64_STANDARD.decode(encoded).ok()?).ok()?;
    text.split_once(':').map(|(_, password)| password.to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use axum::http::Method;

    fn with(name: header::HeaderName, value: &str) -> HeaderMap {
        HeaderMap::from_iter([(name, value.parse().unwrap())])
    }

    /// The status of a refusal, and whether it counts as a wrong key.
    fn status(refused: std::result::Result<(), Refusal>) -> (u16, bool) {
        match refused.unwrap_err() {
            Refusal::Problem(problem) => (problem.status, false),
            Refusal::WrongKey(problem) => (problem.status, true),
        }
    }

    #[test]
    fn only_the_key_opens() {
        let key = ApiKey::new("secret");
        let ask = |method: Method, value: &str| {
            authorised(&key, method.is_safe(), &with(header::AUTHORIZATION, value)).is_ok()
        };
        assert!(ask(Method::POST, "Bearer secret") && ask(Method::GET, "bearer secret"));
        assert!(
            !ask(Method::GET, "Bearer secre")
                && !ask(Method::GET, "secret")
                && !ask(Method::GET, "Basic !")
        );
        let wrong = with(header::AUTHORIZATION, "Bearer secre");
        assert_eq!(status(authorised(&key, true, &wrong)), (401, true));
        let basic = format!("Basic {}", BASE64_STANDARD.encode("me:secret"));
        assert!(ask(Method::GET, &basic) && !ask(Method::POST, &basic));
        assert_eq!(status(authorised(&key, true, &HeaderMap::new())), (401, false));
    }
}
