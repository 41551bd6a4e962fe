//! Pages as HTTP answers.

use std::convert::Infallible;

use axum::body::Body;
use axum::http::{HeaderName, HeaderValue, header};
use axum::response::{IntoResponse, Redirect, Response};
use futures::{FutureExt as _, StreamExt as _, stream};
use sistership_jobs::budget::{RequestMemory, run_with_request_memory};
use sistership_pages::{Language, from_content};

use crate::problem::Result;
use crate::rights::carry_actor;
use crate::web::language::VARY;

const REFERRER_POLICY: HeaderName = header::REFERRER_POLICY;

/// Returns a page whose content takes time: the part before the content is sent at once. A client
/// that hangs up before a permit for the work is free takes none.
pub(super) fn stream_page(
    beginning: String,
    page: impl Future<Output = Result<String>> + Send + 'static,
) -> Response {
    // An error can no longer change the status, so that the content is that of the problem's page.
    let content =
        run_with_request_memory(RequestMemory::current(), carry_actor(page.boxed())).map(|page| {
            let page = page.unwrap_or_else(|problem| problem.to_page().unwrap_or_default());
            from_content(&page).to_owned()
        });
    let content = Language::current().run_scoped(content);
    let parts = stream::once(std::future::ready(beginning)).chain(stream::once(content));
    page_response(Body::from_stream(parts.map(Ok::<_, Infallible>)))
}

/// Returns a page with its headers.
pub(super) fn page_response(html: impl Into<Body>) -> Response {
    let head = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::security_policy()),
        (header::CACHE_CONTROL, "no-cache"),
        (REFERRER_POLICY, "same-origin"),
        (header::VARY, VARY),
    ];
    (head, html.into()).into_response()
}

/// Returns an SVG picture with the value of its `Cache-Control`.
pub(super) fn picture_response(svg: &str, cached: &'static str) -> Response {
    let head = [
        (header::CONTENT_TYPE, "image/svg+xml"),
        (header::CONTENT_SECURITY_POLICY, "default-src 'none'"),
        (header::CACHE_CONTROL, cached),
    ];
    (head, svg.to_owned()).into_response()
}

/// Redirects to a page after an action (RFC 9110, 15.4.4).
pub(super) fn redirect_to(place: &str) -> Response {
    Redirect::to(place).into_response()
}

/// Adds a cookie that scripts cannot read and that links from other sites carry.
pub(super) fn with_cookie(mut response: Response, cookie: &str) -> Response {
    if let Ok(cookie) = HeaderValue::try_from(format!("{cookie}; HttpOnly; SameSite=Lax")) {
        response.headers_mut().append(header::SET_COOKIE, cookie);
    }
    response
}

/// Longest path to redirect to, bytes: it must fit into a cookie.
const LONGEST_PATH: usize = 2000;

/// Returns a path of this server to redirect to; the front page if `next` leads elsewhere. Browsers
/// remove tabs and ends of lines before they resolve a link.
pub(super) fn local_path(next: Option<&str>) -> &str {
    let own = |next: &&str| {
        let plain = next.len() <= LONGEST_PATH && next.bytes().all(|byte| byte.is_ascii_graphic());
        plain && next.starts_with('/') && !next[1..].starts_with(['/', '\\'])
    };
    next.filter(own).unwrap_or("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_sent_elsewhere() {
        assert_eq!(local_path(Some("/ships/kcs?a=b")), "/ships/kcs?a=b");
        for other in [
            "//evil.example",
            "/\\evil.example",
            "/\t/evil.example",
            "/\n/evil.example",
            "https://evil.example",
            "",
            "ships",
        ] {
            assert_eq!(local_path(Some(other)), "/", "{other}");
        }
        assert_eq!(local_path(Some(&format!("/{}", "a".repeat(2000)))), "/");
        assert_eq!(local_path(None), "/");
    }
}
