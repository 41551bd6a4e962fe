//! Requests to a provider: bounded in time and size, and never followed elsewhere.

use std::time::Duration;

use reqwest::{Client, RequestBuilder, StatusCode, redirect};
use serde::de::DeserializeOwned;

use crate::openid::failure::{Failure, Result};

/// How long a provider may take for one answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// The longest answer, bytes.
const LONGEST: usize = 1 << 20;

/// Whoever asks the provider. The process must have provided its cryptography before.
///
/// # Errors
/// The system has no certificates to trust.
pub(crate) fn client() -> Result<Client> {
    let client = Client::builder()
        .timeout(PATIENCE)
        .connect_timeout(PATIENCE / 2)
        .redirect(redirect::Policy::none())
        .user_agent(concat!("sistership/", env!("CARGO_PKG_VERSION")));
    client.build().map_err(|_| Failure::Unreachable("no trusted certificates".to_owned()))
}

/// Status and body of an answer.
///
/// # Errors
/// None comes in time, or it is too long.
pub(crate) async fn answer(request: RequestBuilder) -> Result<(StatusCode, Vec<u8>)> {
    let mut response = request.send().await.map_err(|error| words(&error))?;
    let status = response.status();
    if status.is_server_error() {
        return Err(Failure::Unreachable(format!("it answers {}", status.as_u16())));
    }
    let mut body = Vec::new();
    while let Some(chunk) = response.chunk().await.map_err(|error| words(&error))? {
        if body.len() + chunk.len() > LONGEST {
            return Err(Failure::Provider("its answer is too long".to_owned()));
        }
        body.extend_from_slice(&chunk);
    }
    Ok((status, body))
}

/// A document that must be there.
///
/// # Errors
/// It is not, or does not read.
pub(crate) async fn document(request: RequestBuilder, what: &str) -> Result<Vec<u8>> {
    match answer(request).await? {
        (StatusCode::OK, body) => Ok(body),
        (status, _) => {
            Err(Failure::Provider(format!("its {what} is answered {}", status.as_u16())))
        }
    }
}

/// A document of JSON.
///
/// # Errors
/// It does not read.
pub(crate) fn read<T: DeserializeOwned>(body: &[u8], what: &str) -> Result<T> {
    serde_json::from_slice(body)
        .map_err(|_| Failure::Provider(format!("its {what} is not what the standard asks for")))
}

/// Why, without the address: it may hold a code.
fn words(error: &reqwest::Error) -> Failure {
    let kind = if error.is_timeout() {
        "no answer in time"
    } else if error.is_connect() {
        "no connection"
    } else {
        "the request broke off"
    };
    Failure::Unreachable(kind.to_owned())
}
