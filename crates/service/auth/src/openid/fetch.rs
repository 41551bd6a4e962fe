//! Requests to a provider: bounded in time and size, without redirects.

use std::time::Duration;

use reqwest::{Client, RequestBuilder, StatusCode, redirect};
use serde::de::DeserializeOwned;

use crate::openid::failure::{Result, SignInFailure};

/// Maximum time for one answer of a provider.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum size of an answer, bytes.
const MAX_ANSWER_BYTES: usize = 1 << 20;

/// Creates the client for requests to the provider. The process must have installed its
/// cryptography before.
///
/// # Errors
/// Returns an error if the system has no trusted certificates.
pub(crate) fn build_client() -> Result<Client> {
    let client = Client::builder()
        .timeout(TIMEOUT)
        .connect_timeout(TIMEOUT / 2)
        .redirect(redirect::Policy::none())
        .user_agent(concat!("sistership/", env!("CARGO_PKG_VERSION")));
    client.build().map_err(|_| SignInFailure::Unreachable("no trusted certificates".to_owned()))
}

/// Returns status and body of an answer.
///
/// # Errors
/// Returns an error if there is no answer in time, if it is a server error, or if it is too long.
pub(crate) async fn fetch_answer(request: RequestBuilder) -> Result<(StatusCode, Vec<u8>)> {
    let mut response = request.send().await.map_err(|error| describe_error(&error))?;
    let status = response.status();
    if status.is_server_error() {
        return Err(SignInFailure::Unreachable(format!(
            "it answers with status {}",
            status.as_u16()
        )));
    }
    // Read in chunks, so that the bound applies before the whole answer is in memory.
    let mut body = Vec::new();
    while let Some(chunk) = response.chunk().await.map_err(|error| describe_error(&error))? {
        if body.len() + chunk.len() > MAX_ANSWER_BYTES {
            return Err(SignInFailure::Provider("its answer is too long".to_owned()));
        }
        body.extend_from_slice(&chunk);
    }
    Ok((status, body))
}

/// Returns the body of an answer with the status 200.
///
/// # Errors
/// Returns an error for another status, or if there is no answer.
pub(crate) async fn fetch_document(request: RequestBuilder, what: &str) -> Result<Vec<u8>> {
    match fetch_answer(request).await? {
        (StatusCode::OK, body) => Ok(body),
        (status, _) => Err(SignInFailure::Provider(format!(
            "the request of its {what} gives {}",
            status.as_u16()
        ))),
    }
}

/// Parses a JSON document.
///
/// # Errors
/// Returns an error if it does not have the expected form.
pub(crate) fn parse_document<T: DeserializeOwned>(body: &[u8], what: &str) -> Result<T> {
    serde_json::from_slice(body).map_err(|_| {
        SignInFailure::Provider(format!("its {what} does not conform to the standard"))
    })
}

/// Returns the kind of a failed request without its URL, which may contain a code.
fn describe_error(error: &reqwest::Error) -> SignInFailure {
    let kind = if error.is_timeout() {
        "no answer in time"
    } else if error.is_connect() {
        "no connection"
    } else {
        "the connection was interrupted"
    };
    SignInFailure::Unreachable(kind.to_owned())
}
