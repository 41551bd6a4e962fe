//! Outermost layer of every request: an id, a line in the log, and problem details for errors that
//! no handler made.

use std::sync::atomic::Ordering;
use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderValue, Response as HttpResponse, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use tracing::Instrument as _;
use uuid::Uuid;

use crate::app::App;
use crate::problem::{MEDIA, Problem};
use crate::web::language::{VARY, request_language};
use sistership_listener::PeerInfo;
use sistership_web_support::large::count_large;
use sistership_web_support::trace_context::{TRACE_PARENT, set_remote_parent};

/// Gives the request an id, logs and counts it, and turns every error into a problem with that id.
pub(crate) async fn wrap_request(State(app): State<App>, request: Request, next: Next) -> Response {
    let id = Uuid::now_v7();
    let (method, route) = (request.method().clone(), route_path(&request));
    let peer = request.extensions().get::<PeerInfo>().cloned();
    let (for_people, language) = (is_for_people(&request), request_language(request.headers()));
    let span = tracing::info_span!("request", %id, method = %request.method(), path = request.uri().path());
    let parent = request.headers().get(TRACE_PARENT).and_then(|value| value.to_str().ok());
    set_remote_parent(&span, parent);
    let answer = async move {
        let start = Instant::now();
        // The memory that the request takes is released when this scope ends, whatever the handler
        // does.
        let response = app
            .request_memory()
            .run_async(async { count_large(next.run(request).await).await })
            .await;
        let slow = peer.is_some_and(|peer| peer.is_too_slow());
        let response = finish_response(if slow { too_slow() } else { response }, id, for_people);
        let elapsed = start.elapsed();
        // From then on the maintenance checks for space more often.
        if response.status() == StatusCode::INSUFFICIENT_STORAGE {
            app.is_out_of_space().store(true, Ordering::Relaxed);
        }
        tracing::info!(
            status = response.status().as_u16(),
            elapsed_ms = elapsed.as_millis() as u64,
            "answered"
        );
        app.metrics().count_answer(&method, &route, response.status(), elapsed);
        response
    };
    // Around everything: the page of an error is rendered by this layer.
    language.run_scoped(answer.instrument(span)).await
}

/// The path as the router declares it, with names in place of ids.
fn route_path(request: &Request) -> String {
    request.extensions().get::<MatchedPath>().map_or("none", MatchedPath::as_str).to_owned()
}

/// Returns true if a browser asks for the answer as a page.
fn is_for_people(request: &Request) -> bool {
    let accepted = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let page = accepted.is_some_and(|accepted| accepted.contains("text/html"));
    page && !request.uri().path().starts_with("/v1")
}

fn finish_response(response: Response, id: Uuid, for_people: bool) -> Response {
    let failed = response.status().is_client_error() || response.status().is_server_error();
    let mut response = if failed { problem_response(response, id, for_people) } else { response };
    let headers = response.headers_mut();
    if let Ok(id) = HeaderValue::try_from(id.to_string()) {
        headers.insert("x-request-id", id);
    }
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    response
}

/// Answer to a request whose body did not come in time, whatever the handler has made of the half
/// that did.
fn too_slow() -> Response {
    let why = "the body arrived too slowly or not at all; send it again, or over a faster \
               connection";
    Problem::new(StatusCode::REQUEST_TIMEOUT, why).into_response()
}

/// Returns the response with a problem as its body; its other headers stay (`Allow`,
/// `WWW-Authenticate`).
fn problem_response(response: Response, id: Uuid, for_people: bool) -> Response {
    let (mut parts, _) = response.into_parts();
    let mut problem = parts
        .extensions
        .remove::<Problem>()
        .unwrap_or_else(|| Problem::new(parts.status, status_advice(parts.status)));
    problem.instance = Some(format!("urn:uuid:{id}"));
    let page = for_people.then(|| problem.to_page()).flatten();
    let (fresh, body) = problem.into_response().into_parts();
    // The length is that of the body that is replaced.
    parts.headers.remove(header::CONTENT_LENGTH);
    parts.headers.extend(fresh.headers);
    let Some(page) = page else {
        parts.headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA));
        return HttpResponse::from_parts(parts, body);
    };
    let head = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::security_policy()),
        (header::VARY, VARY),
    ];
    head.into_iter().for_each(|(name, value)| {
        parts.headers.insert(name, HeaderValue::from_static(value));
    });
    parts.headers.remove(header::CONTENT_LENGTH);
    HttpResponse::from_parts(parts, page.into())
}

/// Advice on an error that a layer made.
fn status_advice(status: StatusCode) -> &'static str {
    match status {
        StatusCode::METHOD_NOT_ALLOWED => {
            "this path does not support the method; the header `Allow` lists the supported ones"
        }
        StatusCode::PAYLOAD_TOO_LARGE => "the body is larger than this endpoint accepts",
        StatusCode::REQUEST_TIMEOUT | StatusCode::GATEWAY_TIMEOUT => {
            "the request took too long; send less at a time, or try again later"
        }
        StatusCode::INTERNAL_SERVER_ERROR => {
            "an internal error occurred; the server's log has the cause under the id in `instance`"
        }
        _ => "the request was refused",
    }
}

/// Answer to a path without a route.
pub(crate) async fn no_route(request: Request) -> Problem {
    Problem::not_found(format!(
        "there is no {}; /openapi.json lists all paths",
        request.uri().path()
    ))
}

/// Answer if a handler panicked.
pub(crate) fn panic_response(reason: Box<dyn std::any::Any + Send>) -> Response {
    let text = reason
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| reason.downcast_ref::<&str>().copied());
    Problem::internal(text.unwrap_or("a panic without a message")).into_response()
}
