//! A document as a body: JSON or YAML, whole and bounded.

use axum::RequestExt as _;
use axum::extract::{FromRef, FromRequest, Request};
use axum::http::{HeaderMap, StatusCode, header};
use bytes::{Bytes, BytesMut};
use futures::StreamExt as _;
use serde::de::DeserializeOwned;

use crate::problem::{Fault, Problem, Result};
use sistership_jobs::budget;

/// Memory that reading a document takes, by its bytes: the most that documents of one MiB made the
/// server grow by, measured at its `VmHWM` with one document for each server. YAML: a list of one
/// letter each 93, of empty lists 83, a list one a line 67, a map 60, a law written out many times
/// 26. JSON: a list of empty texts 17, of numbers 13.
const YAML_FACTOR: u64 = 96;
const JSON_FACTOR: u64 = 20;

/// A body that is one document.
#[derive(Debug)]
pub struct Payload {
    media: String,
    bytes: Bytes,
}

/// The most that a document may have.
#[derive(Debug, Clone, Copy)]
pub struct DocumentLimits {
    /// Of JSON, bytes.
    pub json_bytes: usize,
    /// Of YAML, bytes.
    pub yaml_bytes: usize,
}

impl<S: Send + Sync> FromRequest<S> for Payload
where
    DocumentLimits: FromRef<S>,
{
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self> {
        let limits = DocumentLimits::from_ref(state);
        plain(request.headers())?;
        let media = media(request.headers());
        let mut payload = Self { media, bytes: Bytes::new() };
        let (most, factor) = match payload.is_json() {
            true => (limits.json_bytes, JSON_FACTOR),
            false => (limits.yaml_bytes, YAML_FACTOR),
        };
        payload.bytes = whole(request, most).await?;
        budget::take(factor * payload.bytes.len() as u64).await?;
        Ok(payload)
    }
}

/// A body that is counted while it arrives: who stalls has taken no more than was sent.
async fn whole(request: Request, most: usize) -> Result<Bytes> {
    let mut stream = request.with_limited_body().into_body().into_data_stream();
    let mut bytes = BytesMut::new();
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(interrupted)?;
        if bytes.len() + chunk.len() > most {
            return Err(too_large(&format!(
                "the document is larger than the {} KiB that are read",
                most >> 10
            )));
        }
        // The buffer grows by doubling.
        budget::take(2 * chunk.len() as u64).await?;
        bytes.extend_from_slice(&chunk);
    }
    Ok(bytes.freeze())
}

fn interrupted(error: axum::Error) -> Problem {
    let text = error.to_string();
    match text.contains("length limit") {
        true => too_large("the body is larger than this endpoint reads"),
        false => Problem::bad_request(format!("the body broke off: {text}")),
    }
}

fn too_large(what: &str) -> Problem {
    Problem::new(StatusCode::PAYLOAD_TOO_LARGE, format!("{what}; trials go to /v1/trials"))
}

/// A JSON document, whose faults are told by field.
///
/// # Errors
/// Names the field and the line.
pub fn from_slice<T: DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    let mut reader = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut reader)
        .map_err(|error| refused(&error.path().to_string(), error.inner()))?;
    reader.end().map_err(|error| refused(".", &error))?;
    Ok(value)
}

/// Takes the memory that a YAML document which has arrived takes to be read.
///
/// # Errors
/// There is none.
pub async fn read_yaml(bytes: usize) -> Result<()> {
    Ok(budget::take(YAML_FACTOR * bytes as u64).await?)
}

/// The media type of a body, in lower case and without parameters; empty where there is none.
pub fn media(headers: &HeaderMap) -> String {
    let value =
        headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    value.split(';').next().unwrap_or_default().trim().to_ascii_lowercase()
}

/// Refuses a compressed body: what it grows to is not bounded by what is sent.
///
/// # Errors
/// It is one.
pub fn plain(headers: &HeaderMap) -> Result<()> {
    match headers.get(header::CONTENT_ENCODING) {
        Some(encoding) if encoding != "identity" => Err(Problem::new(
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            "send the body without Content-Encoding",
        )),
        _ => Ok(()),
    }
}

impl Payload {
    /// The bytes, which tell one request from another.
    pub fn bytes(&self) -> &Bytes {
        &self.bytes
    }

    /// Whether it says that it is JSON.
    pub fn is_json(&self) -> bool {
        self.media == "application/json" || self.media.ends_with("+json")
    }

    fn is_text(&self) -> bool {
        let known =
            ["application/yaml", "application/x-yaml", "text/yaml", "text/x-yaml", "text/plain"];
        known.contains(&self.media.as_str())
    }

    /// The JSON document.
    ///
    /// # Errors
    /// It is of another type, or does not read; names the field and the line.
    pub fn json<T: DeserializeOwned>(&self) -> Result<T> {
        if !self.is_json() {
            return Err(self.wrong("application/json"));
        }
        from_slice(&self.bytes)
    }

    /// The YAML document as text.
    ///
    /// # Errors
    /// It is of another type, or no UTF-8.
    pub fn text(&self) -> Result<&str> {
        if !self.is_text() {
            return Err(self.wrong("application/yaml"));
        }
        std::str::from_utf8(&self.bytes)
            .map_err(|error| Problem::bad_request(format!("the body is not UTF-8: {error}")))
    }

    /// A refusal of the content type.
    pub fn wrong(&self, wanted: &str) -> Problem {
        let found =
            if self.media.is_empty() { "nothing".to_owned() } else { format!("`{}`", self.media) };
        let detail = format!("Content-Type is {found}; send `{wanted}`");
        Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail)
    }
}

/// What the JSON library calls Rust's types, for people.
const TYPES: [(&str, &str); 4] = [
    ("expected f64", "expected a number"),
    ("expected usize", "expected a whole number"),
    ("expected i64", "expected a whole number"),
    ("a sequence", "a list"),
];

/// Broken JSON is 400, JSON that says the wrong thing 422.
fn refused(path: &str, error: &serde_json::Error) -> Problem {
    let status =
        if error.is_data() { StatusCode::UNPROCESSABLE_ENTITY } else { StatusCode::BAD_REQUEST };
    let message = TYPES.iter().fold(error.to_string(), |text, (from, to)| text.replace(from, to));
    let (place, field) = if path == "." {
        (String::new(), None)
    } else {
        (format!("{path}: "), Some(path.to_owned()))
    };
    let detail = format!("{place}{message}");
    Problem::new(status, detail).with(Fault {
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
        let payload = Payload { media: media.into(), bytes: text.to_owned().into() };
        payload.json::<std::collections::BTreeMap<String, Inner>>().unwrap_err()
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
