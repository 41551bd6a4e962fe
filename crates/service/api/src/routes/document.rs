//! The OpenAPI document.

use axum::http::header;
use axum::response::IntoResponse;
use serde_json::Value;

use super::{described, endpoints};
use crate::config::Limits;
use sistership_web_support::{operations, tidy};

/// Returns the contract of the server, as `/openapi.json` serves it.
pub fn openapi() -> Value {
    let mut document = endpoints::api_router(&Limits::default()).into_openapi();
    operations::complete_operations(&mut document);
    // The remaining steps change the serialized form, which utoipa's types cannot express.
    let mut document = serde_json::to_value(&document).unwrap_or_default();
    described::add_request_schemas(&mut document);
    tidy::tidy_document(&mut document);
    document
}

/// Returns the document as text, indented, with a line feed at its end.
pub(super) fn document_text() -> String {
    serde_json::to_string_pretty(&openapi()).map(|text| text + "\n").unwrap_or_default()
}

pub(super) fn serve_document(text: String) -> axum::response::Response {
    ([(header::CONTENT_TYPE, "application/json")], text).into_response()
}
