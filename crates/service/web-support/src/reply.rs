//! Answers to requests that create something; they can be stored and replayed.

use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};

use crate::problem::{Problem, Result};

/// An answer with its headers, in the form that is stored for replay.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StoredReply {
    /// HTTP status.
    pub status: u16,
    /// URL of the created item.
    pub location: Option<String>,
    /// Entity tag of the created item.
    pub etag: Option<String>,
    /// Body, a JSON document.
    pub body: String,
}

impl StoredReply {
    /// Creates an answer from a document.
    ///
    /// # Errors
    /// Returns an error if the document cannot be written.
    pub fn new(status: StatusCode, body: &impl Serialize) -> Result<Self> {
        let body = serde_json::to_string(body).map_err(Problem::internal)?;
        Ok(Self { status: status.as_u16(), location: None, etag: None, body })
    }

    /// Sets the URL of the created item, by the segments of its path.
    #[must_use]
    pub fn with_location(mut self, segments: &[&str]) -> Self {
        self.location = Some(encode_path(segments));
        self
    }

    /// Sets the URL of a list of the created items: a path and one query parameter.
    #[must_use]
    pub fn with_list_location(mut self, segments: &[&str], (name, value): (&str, &str)) -> Self {
        self.location = Some(format!("{}?{name}={}", encode_path(segments), percent_encode(value)));
        self
    }

    /// Sets the entity tag of the created item.
    #[must_use]
    pub fn with_etag(mut self, etag: String) -> Self {
        self.etag = Some(etag);
        self
    }
}

/// Returns a path of segments, each percent-encoded.
pub fn encode_path(segments: &[&str]) -> String {
    segments.iter().map(|segment| format!("/{}", percent_encode(segment))).collect()
}

/// Percent-encodes every byte except the unreserved ones (RFC 3986, 2.3).
fn percent_encode(text: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte);
    let each = text.bytes().map(|byte| match is_plain(byte) {
        // Unreserved bytes are ASCII, so that each is one character.
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    });
    each.collect()
}

impl IntoResponse for StoredReply {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::OK);
        let mut response =
            (status, [(header::CONTENT_TYPE, "application/json")], self.body).into_response();
        let mut set = |name: HeaderName, value: Option<String>| {
            if let Some(value) = value.and_then(|value| HeaderValue::try_from(value).ok()) {
                response.headers_mut().insert(name, value);
            }
        };
        set(header::LOCATION, self.location);
        set(header::ETAG, self.etag);
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_percent_encoded() {
        assert_eq!(
            encode_path(&["v1", "families", "A/B söhne"]),
            "/v1/families/A%2FB%20s%C3%B6hne"
        );
        assert_eq!(encode_path(&["v1", "users", "a.b_c"]), "/v1/users/a.b_c");
    }
}
