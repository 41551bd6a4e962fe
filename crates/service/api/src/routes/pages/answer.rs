//! A page as an answer.

use std::convert::Infallible;

use axum::body::Body;
use axum::http::{HeaderName, HeaderValue, header};
use axum::response::{IntoResponse, Redirect, Response};
use futures::{FutureExt as _, StreamExt as _, stream};
use sistership_jobs::budget::{Held, carried_on};
use sistership_pages::from_content;

use crate::problem::Result;
use crate::rights::carried;

const REFERRER_POLICY: HeaderName = header::REFERRER_POLICY;

/// A page whose content takes time: what stands before it is sent at once. Whoever hangs up before
/// a seat is free for the work takes none.
pub(super) fn begun(
    beginning: String,
    page: impl Future<Output = Result<String>> + Send + 'static,
) -> Response {
    let content = carried_on(Held::current(), carried(page.boxed())).map(|page| {
        let page = page.unwrap_or_else(|problem| problem.page().unwrap_or_default());
        from_content(&page).to_owned()
    });
    let parts = stream::once(std::future::ready(beginning)).chain(stream::once(content));
    answer(Body::from_stream(parts.map(Ok::<_, Infallible>)))
}

/// With the headers of a page.
pub(super) fn answer(html: impl Into<Body>) -> Response {
    let head = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::policy()),
        (header::CACHE_CONTROL, "no-cache"),
        (REFERRER_POLICY, "same-origin"),
    ];
    (head, html.into()).into_response()
}

/// Where to go once something is done (RFC 9110, 15.4.4).
pub(super) fn then(place: &str) -> Response {
    Redirect::to(place).into_response()
}

/// With a cookie that scripts do not see, and which links from elsewhere bring along.
pub(super) fn with_cookie(mut response: Response, cookie: &str) -> Response {
    if let Ok(cookie) = HeaderValue::try_from(format!("{cookie}; HttpOnly; SameSite=Lax")) {
        response.headers_mut().append(header::SET_COOKIE, cookie);
    }
    response
}

/// The longest place to go to, bytes: it must fit into a cookie.
const LONGEST_PLACE: usize = 2000;

/// A place of this server to go to; its front page where another is named. Browsers leave out tabs
/// and ends of lines before they look at where a link leads.
pub(super) fn own_place(next: Option<&str>) -> &str {
    let own = |next: &&str| {
        let plain = next.len() <= LONGEST_PLACE && next.bytes().all(|byte| byte.is_ascii_graphic());
        plain && next.starts_with('/') && !next[1..].starts_with(['/', '\\'])
    };
    next.filter(own).unwrap_or("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_sent_elsewhere() {
        assert_eq!(own_place(Some("/ships/kcs?a=b")), "/ships/kcs?a=b");
        for other in [
            "//evil.example",
            "/\\evil.example",
            "/\t/evil.example",
            "/\n/evil.example",
            "https://evil.example",
            "",
            "ships",
        ] {
            assert_eq!(own_place(Some(other)), "/", "{other}");
        }
        assert_eq!(own_place(Some(&format!("/{}", "a".repeat(2000)))), "/");
        assert_eq!(own_place(None), "/");
    }
}
