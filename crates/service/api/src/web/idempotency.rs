//! `Idempotency-Key`: a repeated request is carried out once, and answered as it was the first
//! time.

use std::future::Future;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use futures::FutureExt as _;
use sistership_store::{PROLONG_EVERY, RequestClaim, RequestTicket, Store, UnitOfWork, sha256_hex};
use tracing::Instrument as _;

use super::{StoredReply, field::RequestKey};
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::rights::{AuthenticationKind, carry_actor, current_actor};
use sistership_jobs::budget::{RequestMemory, run_with_request_memory};

const HEADER: &str = "idempotency-key";

/// Identity of a request: its key, if it has one, and the method, path and query it belongs to.
#[derive(Debug)]
pub(crate) struct IdempotencyKey {
    /// Key of the caller.
    pub value: Option<String>,
    scope: String,
}

impl<S: Send + Sync> FromRequestParts<S> for IdempotencyKey {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self> {
        let value = parts.headers.get(HEADER).map(check_key).transpose()?;
        let query = parts.uri.query().unwrap_or_default();
        let scope = format!("{} {}", parts.method, parts.uri.path());
        Ok(Self { value, scope: if query.is_empty() { scope } else { format!("{scope}?{query}") } })
    }
}

fn check_key(value: &HeaderValue) -> Result<String> {
    let key = value.to_str().unwrap_or_default().parse::<RequestKey>();
    key.map(RequestKey::into_string).map_err(|message| {
        Problem::bad_request(format!("Idempotency-Key: {message}"))
            .with_fault(Fault::at_field("Idempotency-Key", message))
    })
}

impl IdempotencyKey {
    /// Carries a request out, once for each key. The work gets a handle of the server whose store
    /// keeps all that is written together with the answer, or nothing of it. It runs to its end
    /// even if the caller hangs up.
    pub(crate) async fn run_once<W, F>(self, app: &App, body: &[u8], work: W) -> Result<Response>
    where
        W: FnOnce(App) -> F + Send + 'static,
        F: Future<Output = Result<StoredReply>> + Send + 'static,
    {
        let scope = caller_scope(self.scope);
        let ticket = match &self.value {
            None => None,
            Some(key) => {
                match app
                    .store()
                    .idempotency()
                    .begin_request(&scope, key, &sha256_hex(body))
                    .await?
                {
                    RequestClaim::New(ticket) => Some(ticket),
                    RequestClaim::Replay { body, .. } => return replay_reply(&body),
                    RequestClaim::InProgress => return Err(in_progress()),
                    RequestClaim::Mismatch => return Err(key_mismatch()),
                }
            }
        };
        Ok(detach(carry_out(app.clone(), ticket, work)).await?.into_response())
    }
}

/// Scope of a key: the same key sent under another name gets no answer of somebody else.
fn caller_scope(scope: String) -> String {
    match current_actor().map(|acting| acting.principal) {
        // Local programs and the server's key act for one owner, and share a scope.
        Some(who)
            if !matches!(who.kind, AuthenticationKind::Local | AuthenticationKind::ServerKey) =>
        {
            format!("{scope} by {}", who.name)
        }
        _ => scope,
    }
}

/// Waits for work that goes on even if the caller does not wait. The future is boxed before it is
/// moved, as it is large.
fn detach<T: Send + 'static>(
    work: impl Future<Output = Result<T>> + Send + 'static,
) -> impl Future<Output = Result<T>> + Send {
    let work = run_with_request_memory(RequestMemory::current(), carry_actor(work.boxed()))
        .in_current_span();
    async move { tokio::spawn(work).await.map_err(Problem::internal)? }
}

/// Commits the work with its answer; a request that failed is forgotten, so that it can be tried
/// again.
async fn carry_out<W, F>(app: App, ticket: Option<RequestTicket>, work: W) -> Result<StoredReply>
where
    W: FnOnce(App) -> F,
    F: Future<Output = Result<StoredReply>> + Send + 'static,
{
    let unit = app.store().begin_unit();
    let work = detach(work(app.with_store(unit.store())));
    let kept = match with_ticket(app.store(), ticket.as_ref(), work).await {
        Ok(reply) => commit_reply(unit, ticket.as_ref(), reply).await,
        Err(problem) => {
            unit.rollback().await;
            Err(problem)
        }
    };
    if let (Err(_), Some(ticket)) = (&kept, &ticket) {
        abandon_ticket(app.store(), ticket).await;
    }
    kept
}

/// Returns the outcome of the work and keeps the ticket alive meanwhile.
async fn with_ticket(
    store: &Store,
    ticket: Option<&RequestTicket>,
    work: impl Future<Output = Result<StoredReply>>,
) -> Result<StoredReply> {
    let Some(ticket) = ticket else { return work.await };
    // The ticket expires unless it is renewed, so that a request whose process has ended can be
    // repeated.
    let prolonging = async {
        loop {
            tokio::time::sleep(PROLONG_EVERY).await;
            if let Err(error) = store.idempotency().prolong_ticket(ticket).await {
                tracing::warn!(%error, "a request could not renew its lease");
            }
        }
    };
    tokio::select! {
        done = work => done,
        // The loop never ends by itself; the arm satisfies the types.
        () = prolonging => Err(Problem::internal("a background task has ended")),
    }
}

async fn commit_reply(
    unit: UnitOfWork,
    ticket: Option<&RequestTicket>,
    reply: StoredReply,
) -> Result<StoredReply> {
    let text = serde_json::to_string(&reply).map_err(Problem::internal)?;
    unit.commit(ticket.map(|ticket| (ticket, i64::from(reply.status), text.as_str()))).await?;
    Ok(reply)
}

/// Gives up a ticket, in the background where the database does not answer.
async fn abandon_ticket(store: &Store, ticket: &RequestTicket) {
    if let Err(error) = store.idempotency().abandon_ticket(ticket).await {
        tracing::warn!(%error, "the record of a failed request could not be removed yet");
        store.idempotency().abandon_in_background(ticket.clone());
    }
}

fn replay_reply(text: &str) -> Result<Response> {
    let reply: StoredReply = serde_json::from_str(text).map_err(Problem::internal)?;
    let mut response = reply.into_response();
    response.headers_mut().insert("idempotency-replayed", HeaderValue::from_static("true"));
    Ok(response)
}

fn in_progress() -> Problem {
    Problem::new(
        StatusCode::CONFLICT,
        "a request with this Idempotency-Key is in progress; repeat it in a moment",
    )
}

fn key_mismatch() -> Problem {
    let detail =
        "this Idempotency-Key was used for another request; use a new key for a new request";
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, detail)
}
