//! Problem details (RFC 9457): the common form of all errors.

mod from;

use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use sistership_pages::PageProblem;
use utoipa::ToSchema;

/// Media type of [`Problem`].
pub const MEDIA: &str = "application/problem+json";

/// Value of `Retry-After` for a request that was refused for lack of capacity, s.
const RETRY_AFTER_S: &str = "5";

/// Result of an operation of the server.
pub type Result<T, E = Problem> = std::result::Result<T, E>;

/// Reason why a request was not carried out, and how to correct it.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Problem {
    /// A URI that names the kind of problem.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The kind of problem in words.
    pub title: &'static str,
    /// Returns the HTTP status.
    pub status: u16,
    /// Description of this occurrence, and how to correct it.
    pub detail: String,
    /// A URI that identifies this occurrence; the server's log has the same id.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
    /// The individual faults, if they can be located; else empty.
    pub errors: Vec<Fault>,
}

/// One fault with its location.
#[derive(Debug, Clone, Default, PartialEq, Serialize, ToSchema)]
pub struct Fault {
    /// The field of a document (dotted path), or the file of an upload.
    pub field: Option<String>,
    /// The row of a file or the line of a document, counted from 1.
    pub row: Option<usize>,
    /// The column of a file.
    pub column: Option<String>,
    /// Description of the fault, and the expected value.
    pub message: String,
}

/// Status, URI and title of each kind of problem.
const KINDS: [(u16, &str, &str); 19] = [
    (400, "urn:sistership:problem:bad-request", "The request cannot be read"),
    (401, "urn:sistership:problem:unauthorized", "A key or a sign-in is needed"),
    (403, "urn:sistership:problem:forbidden", "The request is not allowed"),
    (404, "urn:sistership:problem:not-found", "Not found"),
    (405, "urn:sistership:problem:method-not-allowed", "The method is not supported here"),
    (406, "urn:sistership:problem:not-acceptable", "None of the accepted formats is available"),
    (408, "urn:sistership:problem:request-timeout", "The request took too long to arrive"),
    (409, "urn:sistership:problem:conflict", "The request conflicts with stored data"),
    (412, "urn:sistership:problem:stale", "The resource has changed since it was read"),
    (413, "urn:sistership:problem:too-large", "The request is too large"),
    (
        415,
        "urn:sistership:problem:unsupported-media-type",
        "The content type is not supported here",
    ),
    (422, "urn:sistership:problem:invalid", "The content is not valid"),
    (428, "urn:sistership:problem:precondition-required", "A precondition header is needed"),
    (429, "urn:sistership:problem:too-many-requests", "Too many requests"),
    (431, "urn:sistership:problem:headers-too-large", "The headers are too large"),
    (500, "urn:sistership:problem:internal", "Internal error"),
    (503, "urn:sistership:problem:unavailable", "The server is temporarily unavailable"),
    (504, "urn:sistership:problem:timeout", "The request took too long"),
    (507, "urn:sistership:problem:no-room", "There is no free space"),
];

impl Problem {
    /// Creates a problem of the kind that belongs to a status.
    pub fn new(status: StatusCode, detail: impl Into<String>) -> Self {
        // Other statuses become `about:blank`, which RFC 9457 defines as without a type of its own.
        let known = KINDS.iter().find(|(known, ..)| *known == status.as_u16());
        let (_, kind, title) = known.copied().unwrap_or((
            0,
            "about:blank",
            status.canonical_reason().unwrap_or("Problem"),
        ));
        Self {
            kind,
            title,
            status: status.as_u16(),
            detail: detail.into(),
            instance: None,
            errors: Vec::new(),
        }
    }

    /// Creates the problem of a request that cannot be read.
    pub fn bad_request(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, detail)
    }

    /// Creates the problem of a missing item.
    pub fn not_found(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::NOT_FOUND, detail)
    }

    /// Creates the problem of a document with one invalid field.
    pub fn invalid(field: &str, message: impl Into<String>) -> Self {
        Self::all_invalid([(field.to_owned(), message.into())])
    }

    /// Creates the problem of a document with several invalid fields, pairs of field and message.
    pub fn all_invalid(faults: impl IntoIterator<Item = (String, String)>) -> Self {
        let faults: Vec<(String, String)> = faults.into_iter().collect();
        let told = faults.iter().map(|(field, message)| format!("{field}: {message}"));
        let detail = told.collect::<Vec<_>>().join("; ");
        let problem = Self::new(StatusCode::UNPROCESSABLE_ENTITY, detail);
        faults
            .into_iter()
            .fold(problem, |all, (field, message)| all.with_fault(Fault::at_field(field, message)))
    }

    /// Creates the problem of an internal failure; the reason is logged, not answered.
    pub fn internal(reason: impl std::fmt::Display) -> Self {
        tracing::error!(%reason, "internal error");
        Self::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "an internal error occurred; the server's log has the cause under the id in `instance`",
        )
    }

    /// Creates the problem of a full disk; the reason is logged, not answered.
    pub fn no_room(reason: impl std::fmt::Display) -> Self {
        tracing::error!(%reason, "no room");
        let detail = "the server has no free space; nothing was stored. Reading is still \
                      possible; free some space and send the request again";
        Self::new(StatusCode::INSUFFICIENT_STORAGE, detail)
    }

    /// Adds a fault.
    #[must_use]
    pub fn with_fault(mut self, fault: Fault) -> Self {
        self.errors.push(fault);
        self
    }

    /// Renders the problem as an HTML page.
    pub fn to_page(&self) -> Option<String> {
        let place = |fault: &Fault| {
            let row = fault.row.map(|row| format!("row {row}"));
            let parts = [fault.field.clone(), row, fault.column.clone()];
            (parts.into_iter().flatten().collect::<Vec<_>>().join(", "), fault.message.clone())
        };
        let faults: Vec<_> = self.errors.iter().map(place).collect();
        let instance = self.instance.as_deref().unwrap_or_default();
        let page = PageProblem {
            kind: self.kind,
            title: self.title,
            detail: &self.detail,
            faults: &faults,
            instance,
        };
        sistership_pages::problem_page(page).ok()
    }

    /// HTTP status.
    pub fn status(&self) -> StatusCode {
        StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR)
    }
}

impl Fault {
    /// Creates a fault of a field.
    pub fn at_field(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: Some(field.into()), message: message.into(), ..Self::default() }
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let mut response = (self.status(), Json(&self)).into_response();
        response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA));
        // A 401 must name the accepted schemes of authentication.
        if self.status == StatusCode::UNAUTHORIZED {
            let challenge = HeaderValue::from_static("Bearer, Basic realm=\"sistership\"");
            response.headers_mut().insert(header::WWW_AUTHENTICATE, challenge);
        }
        // Failures that pass: the client may repeat the request after a while.
        let later = [StatusCode::TOO_MANY_REQUESTS, StatusCode::SERVICE_UNAVAILABLE];
        if later.iter().any(|status| self.status == *status) {
            response
                .headers_mut()
                .insert(header::RETRY_AFTER, HeaderValue::from_static(RETRY_AFTER_S));
        }
        // A later layer that knows the id of the request adds it, see `api::web::envelope`.
        response.extensions_mut().insert(self);
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_names_its_kind_and_place() {
        let problem = Problem::invalid("settings.folds", "must be from 2 to 100");
        let json = serde_json::to_value(&problem).unwrap_or_default();
        assert_eq!(json["type"], "urn:sistership:problem:invalid");
        assert_eq!(json["errors"][0]["field"], "settings.folds");
        assert_eq!(json["status"], 422);
        assert_eq!(Problem::new(StatusCode::IM_A_TEAPOT, "").kind, "about:blank");
    }
}
