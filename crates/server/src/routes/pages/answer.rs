//! A page as an answer.

use askama::Template;
use axum::http::header;
use axum::response::{IntoResponse, Response};

use crate::problem::{Problem, Result};

/// What a page may load: nothing but its own styles and pictures.
pub(in crate::routes) const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; form-action 'none'; frame-ancestors 'none'";

/// With the headers of a page.
pub(super) fn answer(page: &impl Template) -> Result<Response> {
    let html = page.render().map_err(Problem::internal)?;
    let head = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
    ];
    Ok((head, html).into_response())
}
