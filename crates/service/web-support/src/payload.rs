//! Bodies that are one document, JSON or YAML, of bounded size.

use axum::RequestExt as _;
use axum::extract::{FromRef, FromRequest, Request};
use axum::http::{HeaderMap, StatusCode, header};
use bytes::{Bytes, BytesMut};
use futures::StreamExt as _;
use serde::de::DeserializeOwned;

use crate::problem::{Fault, Problem, Result};
use sistership_jobs::budget;

/// Memory for parsing a document, as a multiple of its size: the largest growth of the server for
/// documents of one MiB, measured as `VmHWM` with one document for each server. YAML: a list of one
/// letter each 93, of empty lists 83, a list one a line 67, a map 60, a law written out many times
/// 26. JSON: a list of empty texts 17, of numbers 13.
const YAML_FACTOR: u64 = 96;
const JSON_FACTOR: u64 = 20;

/// A body that is one document.
#[derive(Debug)]
pub struct DocumentBody {
    media: String,
    bytes: Bytes,
}

/// Maximum sizes of documents.
#[derive(Debug, Clone, Copy)]
pub struct DocumentLimits {
    /// JSON, bytes.
    pub json_bytes: usize,
    /// YAML, bytes.
    pub yaml_bytes: usize,
}

impl<S: Send + Sync> FromRequest<S> for DocumentBody
where
    DocumentLimits: FromRef<S>,
{
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self> {
        let limits = DocumentLimits::from_ref(state);
        // Compression is refused first: the limits below apply to the bytes that are sent.
        check_uncompressed(request.headers())?;
        let media = media_type(request.headers());
        let mut payload = Self { media, bytes: Bytes::new() };
        let (most, factor) = match payload.is_json() {
            true => (limits.json_bytes, JSON_FACTOR),
            false => (limits.yaml_bytes, YAML_FACTOR),
        };
        payload.bytes = read_body(request, most).await?;
        // Memory for parsing, on top of that of the bytes.
        budget::reserve_for_request(factor * payload.bytes.len() as u64).await?;
        Ok(payload)
    }
}

/// Reads a body, counted against the memory budget as it arrives: a stalled client holds no more
/// than it has sent.
async fn read_body(request: Request, most: usize) -> Result<Bytes> {
    let mut stream = request.with_limited_body().into_body().into_data_stream();
    let mut bytes = BytesMut::new();
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(body_problem)?;
        // Tested before the chunk is added, so that the buffer never exceeds the limit.
        if bytes.len() + chunk.len() > most {
            return Err(too_large(&format!(
                "the document is larger than the limit of {} KiB",
                most >> 10
            )));
        }
        // Twice the size, because the buffer grows by doubling.
        budget::reserve_for_request(2 * chunk.len() as u64).await?;
        bytes.extend_from_slice(&chunk);
    }
    Ok(bytes.freeze())
}

fn body_problem(error: axum::Error) -> Problem {
    let text = error.to_string();
    // The library has no type for this error, only its text.
    match text.contains("length limit") {
        true => too_large("the body is larger than this endpoint accepts"),
        false => Problem::bad_request(format!("the body is incomplete: {text}")),
    }
}

fn too_large(what: &str) -> Problem {
    Problem::new(StatusCode::PAYLOAD_TOO_LARGE, format!("{what}; send trials to /v1/trials"))
}

/// Parses a JSON document; faults name the field.
///
/// # Errors
/// Returns an error that names the field and the line.
pub fn from_slice<T: DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    let mut reader = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut reader)
        .map_err(|error| json_problem(&error.path().to_string(), error.inner()))?;
    // Text after the document is an error.
    reader.end().map_err(|error| json_problem(".", &error))?;
    Ok(value)
}

/// Takes memory from the budget for parsing a YAML document of a size in bytes.
///
/// # Errors
/// Returns an error if there is not enough memory.
pub async fn reserve_yaml_memory(bytes: usize) -> Result<()> {
    Ok(budget::reserve_for_request(YAML_FACTOR * bytes as u64).await?)
}

/// Returns the media type of a body, in lower case and without parameters; empty if absent.
pub fn media_type(headers: &HeaderMap) -> String {
    let value =
        headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    value.split(';').next().unwrap_or_default().trim().to_ascii_lowercase()
}

/// Refuses a compressed body: its size after decompression is not bounded by what is sent.
///
/// # Errors
/// Returns an error if the body is compressed.
pub fn check_uncompressed(headers: &HeaderMap) -> Result<()> {
    match headers.get(header::CONTENT_ENCODING) {
        // `identity` means no encoding.
        Some(encoding) if encoding != "identity" => Err(Problem::new(
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            "send the body without Content-Encoding",
        )),
        _ => Ok(()),
    }
}

impl DocumentBody {
    /// Returns the bytes, which also identify a repeated request.
    pub fn bytes(&self) -> &Bytes {
        &self.bytes
    }

    /// Returns true if the media type is JSON.
    pub fn is_json(&self) -> bool {
        self.media == "application/json" || self.media.ends_with("+json")
    }

    fn is_text(&self) -> bool {
        let known =
            ["application/yaml", "application/x-yaml", "text/yaml", "text/x-yaml", "text/plain"];
        known.contains(&self.media.as_str())
    }

    /// Parses the body as a JSON document.
    ///
    /// # Errors
    /// Returns an error if the body has another type or is not valid; it names the field and the
    /// line.
    pub fn parse_json<T: DeserializeOwned>(&self) -> Result<T> {
        if !self.is_json() {
            return Err(self.wrong_type("application/json"));
        }
        from_slice(&self.bytes)
    }

    /// Returns the body as the text of a YAML document.
    ///
    /// # Errors
    /// Returns an error if the body has another type or is not UTF-8.
    pub fn yaml_text(&self) -> Result<&str> {
        if !self.is_text() {
            return Err(self.wrong_type("application/yaml"));
        }
        std::str::from_utf8(&self.bytes)
            .map_err(|error| Problem::bad_request(format!("the body is not UTF-8: {error}")))
    }

    /// Returns the problem of an unsupported content type.
    pub fn wrong_type(&self, wanted: &str) -> Problem {
        let found =
            if self.media.is_empty() { "nothing".to_owned() } else { format!("`{}`", self.media) };
        let detail = format!("Content-Type is {found}; send `{wanted}`");
        Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail)
    }
}

/// Names of Rust types in messages of the JSON library, with replacements for users.
const TYPES: [(&str, &str); 4] = [
    ("expected f64", "expected a number"),
    ("expected usize", "expected a whole number"),
    ("expected i64", "expected a whole number"),
    ("a sequence", "a list"),
];

/// Returns the problem of a JSON document: 400 for a syntax error, 422 for invalid content.
fn json_problem(path: &str, error: &serde_json::Error) -> Problem {
    let status =
        if error.is_data() { StatusCode::UNPROCESSABLE_ENTITY } else { StatusCode::BAD_REQUEST };
    let message = TYPES.iter().fold(error.to_string(), |text, (from, to)| text.replace(from, to));
    let (place, field) = if path == "." {
        (String::new(), None)
    } else {
        (format!("{path}: "), Some(path.to_owned()))
    };
    let detail = format!("{place}{message}");
    Problem::new(status, detail).with_fault(Fault {
        field,
        row: Some(error.line()),
        column: None,
        message,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code, reason = "only read")]
    struct Inner {
        folds: usize,
    }

    fn read(media: &str, text: &str) -> Problem {
        let payload = DocumentBody { media: media.into(), bytes: text.to_owned().into() };
        payload.parse_json::<std::collections::BTreeMap<String, Inner>>().unwrap_err()
    }

    #[test]
    fn faults_of_json_are_placed() {
        let problem = read("application/json", r#"{"settings": {"fold": 3}}"#);
        assert_eq!(
            (problem.status, problem.errors[0].field.as_deref()),
            (422, Some("settings.fold"))
        );
        assert!(
            problem.detail.contains("unknown field `fold`, expected `folds`"),
            "{}",
            problem.detail
        );
        assert_eq!(read("application/json", r#"{"settings": {"folds": "#).status, 400);
        assert_eq!(read("application/json", r#"{} {}"#).status, 400);
        assert!(
            read("application/json", r#"{"a": {"folds": "x"}}"#)
                .detail
                .contains("a.folds: invalid type: string \"x\", expected a whole number")
        );
        assert!(read("text/csv", "{}").detail.contains("`text/csv`"));
    }
}
