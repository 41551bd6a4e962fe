//! `Idempotency-Key`: a request that is repeated is carried out once, and answered as it was the first time.

use std::future::Future;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use sistership_store::{Begun, Store, Ticket, sha256_hex};
use tracing::Instrument as _;

use super::field::RequestKey;
use super::reply::Reply;
use crate::app::App;
use crate::problem::{Fault, Problem, Result};

const HEADER: &str = "idempotency-key";

/// What names a request: its key, if it has one, and what it is made of.
#[derive(Debug)]
pub(crate) struct Key {
    /// The caller's key.
    pub value: Option<String>,
    scope: String,
}

impl<S: Send + Sync> FromRequestParts<S> for Key {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self> {
        let value = parts.headers.get(HEADER).map(check).transpose()?;
        let query = parts.uri.query().unwrap_or_default();
        let scope = format!("{} {}", parts.method, parts.uri.path());
        Ok(Self { value, scope: if query.is_empty() { scope } else { format!("{scope}?{query}") } })
    }
}

fn check(value: &HeaderValue) -> Result<String> {
    let key = value.to_str().unwrap_or_default().parse::<RequestKey>();
    key.map(RequestKey::into_string).map_err(|message| {
        Problem::bad_request(format!("Idempotency-Key: {message}")).with(Fault::at("Idempotency-Key", message))
    })
}

impl Key {
    /// Carries a request out, once for each key. It runs to its end even when the caller hangs up.
    pub(crate) async fn once<F>(self, app: &App, body: &[u8], work: F) -> Result<Response>
    where
        F: Future<Output = Result<Reply>> + Send + 'static,
    {
        let Some(key) = self.value else { return Ok(finished(work).await?.into_response()) };
        let store = app.store().clone();
        match store.idempotency().begin(&self.scope, &key, &sha256_hex(body)).await? {
            Begun::New(ticket) => Ok(finished(kept(store, ticket, work)).await?.into_response()),
            Begun::Replay { body, .. } => replay(&body),
            Begun::InProgress => Err(in_progress()),
            Begun::Mismatch => Err(mismatch()),
        }
    }
}

/// Waits for work that goes on if nobody waits.
async fn finished<T: Send + 'static>(work: impl Future<Output = Result<T>> + Send + 'static) -> Result<T> {
    tokio::spawn(work.in_current_span()).await.map_err(Problem::internal)?
}

/// Keeps the answer; a request that came to nothing is forgotten, so that it can be tried again.
async fn kept(store: Store, ticket: Ticket, work: impl Future<Output = Result<Reply>>) -> Result<Reply> {
    let reply = match work.await {
        Ok(reply) => reply,
        Err(problem) => {
            store.idempotency().abandon(&ticket).await?;
            return Err(problem);
        }
    };
    let text = serde_json::to_string(&reply).map_err(Problem::internal)?;
    if let Err(error) = store.idempotency().finish(&ticket, i64::from(reply.status), &text).await {
        tracing::warn!(%error, "an answer could not be kept for replay");
    }
    Ok(reply)
}

fn replay(text: &str) -> Result<Response> {
    let reply: Reply = serde_json::from_str(text).map_err(Problem::internal)?;
    let mut response = reply.into_response();
    response.headers_mut().insert("idempotency-replayed", HeaderValue::from_static("true"));
    Ok(response)
}

fn in_progress() -> Problem {
    Problem::new(StatusCode::CONFLICT, "a request with this Idempotency-Key is being carried out; repeat it in a moment")
}

fn mismatch() -> Problem {
    let detail = "this Idempotency-Key was used for another request; use a new key for a new request";
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, detail)
}
