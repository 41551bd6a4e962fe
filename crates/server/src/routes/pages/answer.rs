//! A page as an answer.

use axum::http::{HeaderName, header};
use axum::response::{IntoResponse, Redirect, Response};

const REFERRER_POLICY: HeaderName = header::REFERRER_POLICY;

/// With the headers of a page.
pub(super) fn answer(html: String) -> Response {
    let head = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::policy()),
        (header::CACHE_CONTROL, "no-cache"),
        (REFERRER_POLICY, "same-origin"),
    ];
    (head, html).into_response()
}

/// Where to go once something is done (RFC 9110, 15.4.4).
pub(super) fn then(place: &str) -> Response {
    Redirect::to(place).into_response()
}
