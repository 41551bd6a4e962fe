//! The answer to a request that creates something; it can be kept and given again.

use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};

use crate::problem::{Problem, Result};

/// An answer with its headers, in a form that is stored for replay.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reply {
    /// Its status.
    pub status: u16,
    /// Where what was made is.
    pub location: Option<String>,
    /// The tag of what was made.
    pub etag: Option<String>,
    /// A JSON document.
    pub body: String,
    /// Whether there is work for the workers now.
    #[serde(skip)]
    pub queued: bool,
}

impl Reply {
    /// An answer of a document.
    ///
    /// # Errors
    /// The document does not write.
    pub fn new(status: StatusCode, body: &impl Serialize) -> Result<Self> {
        let body = serde_json::to_string(body).map_err(Problem::internal)?;
        Ok(Self { status: status.as_u16(), location: None, etag: None, body, queued: false })
    }

    /// With the place of what was made.
    #[must_use]
    pub fn at(mut self, location: String) -> Self {
        self.location = Some(location);
        self
    }

    /// With jobs that wait, for which the workers are woken once they are kept.
    pub fn with_jobs(mut self) -> Self {
        self.queued = true;
        self
    }

    /// With the tag of what was made.
    #[must_use]
    pub fn tagged(mut self, etag: String) -> Self {
        self.etag = Some(etag);
        self
    }
}

impl IntoResponse for Reply {
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
