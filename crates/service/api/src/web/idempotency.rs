//! `Idempotency-Key`: a repeated request is carried out once, and answered as it was the first
//! time.

use std::future::Future;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use futures::FutureExt as _;
use sistership_store::{Begun, PROLONG_EVERY, Store, Ticket, UnitOfWork, sha256_hex};
use tracing::Instrument as _;

use super::{Reply, field::RequestKey};
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::rights::{Kind, carried, current};
use sistership_jobs::budget::{Held, carried_on};

const HEADER: &str = "idempotency-key";

/// Identity of a request: its key, if it has one, and the method, path and query it belongs to.
#[derive(Debug)]
pub(crate) struct Key {
    /// Key of the caller.
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
        Problem::bad_request(format!("Idempotency-Key: {message}"))
            .with(Fault::at("Idempotency-Key", message))
    })
}

impl Key {
    /// Carries a request out, once for each key. The work gets a handle of the server whose store
    /// keeps all that is written together with the answer, or nothing of it. It runs to its end
    /// even if the caller hangs up.
    pub(crate) async fn once<W, F>(self, app: &App, body: &[u8], work: W) -> Result<Response>
    where
        W: FnOnce(App) -> F + Send + 'static,
        F: Future<Output = Result<Reply>> + Send + 'static,
    {
        let scope = own(self.scope);
        let ticket = match &self.value {
            None => None,
            Some(key) => {
                match app.store().idempotency().begin(&scope, key, &sha256_hex(body)).await? {
                    Begun::New(ticket) => Some(ticket),
                    Begun::Replay { body, .. } => return replay(&body),
                    Begun::InProgress => return Err(in_progress()),
                    Begun::Mismatch => return Err(mismatch()),
                }
            }
        };
        Ok(finished(carried_out(app.clone(), ticket, work)).await?.into_response())
    }
}

/// Scope of a key: the same key sent under another name gets no answer of somebody else.
fn own(scope: String) -> String {
    match current().map(|acting| acting.principal) {
        // Local programs and the server's key act for one owner, and share a scope.
        Some(who) if !matches!(who.kind, Kind::Local | Kind::ServerKey) => {
            format!("{scope} by {}", who.name)
        }
        _ => scope,
    }
}

/// Waits for work that goes on even if the caller does not wait. The future is boxed before it is
/// moved, as it is large.
fn finished<T: Send + 'static>(
    work: impl Future<Output = Result<T>> + Send + 'static,
) -> impl Future<Output = Result<T>> + Send {
    let work = carried_on(Held::current(), carried(work.boxed())).in_current_span();
    async move { tokio::spawn(work).await.map_err(Problem::internal)? }
}

/// Commits the work with its answer; a request that failed is forgotten, so that it can be tried
/// again.
async fn carried_out<W, F>(app: App, ticket: Option<Ticket>, work: W) -> Result<Reply>
where
    W: FnOnce(App) -> F,
    F: Future<Output = Result<Reply>> + Send + 'static,
{
    let unit = app.store().unit();
    let work = finished(work(app.within(unit.store())));
    let kept = match held(app.store(), ticket.as_ref(), work).await {
        Ok(reply) => keep(unit, ticket.as_ref(), reply).await,
        Err(problem) => {
            unit.undo().await;
            // After the commit only: a worker that wakes earlier would not find the job.
            Err(problem)
        }
    };
    match (&kept, &ticket) {
        (Ok(reply), _) if reply.queued => app.wake_all(),
        (Err(_), Some(ticket)) => abandon(app.store(), ticket).await,
        _ => {}
    }
    kept
}

/// Returns the outcome of the work and keeps the ticket alive meanwhile.
async fn held(
    store: &Store,
    ticket: Option<&Ticket>,
    work: impl Future<Output = Result<Reply>>,
) -> Result<Reply> {
    let Some(ticket) = ticket else { return work.await };
    // The ticket expires unless it is renewed, so that a request whose process has ended can be
    // repeated.
    let prolonging = async {
        loop {
            tokio::time::sleep(PROLONG_EVERY).await;
            if let Err(error) = store.idempotency().prolong(ticket).await {
                tracing::warn!(%error, "a request could not say that it goes on");
            }
        }
    };
    tokio::select! {
        done = work => done,
        // The loop never ends by itself; the arm satisfies the types.
        () = prolonging => Err(Problem::internal("a loop without end has ended")),
    }
}

async fn keep(unit: UnitOfWork, ticket: Option<&Ticket>, reply: Reply) -> Result<Reply> {
    let text = serde_json::to_string(&reply).map_err(Problem::internal)?;
    unit.keep(ticket.map(|ticket| (ticket, i64::from(reply.status), text.as_str()))).await?;
    Ok(reply)
}

/// Gives up a ticket. If that fails, a later request takes it over once it has expired.
async fn abandon(store: &Store, ticket: &Ticket) {
    if let Err(error) = store.idempotency().abandon(ticket).await {
        tracing::warn!(%error, "a request that came to nothing could not be forgotten");
    }
}

fn replay(text: &str) -> Result<Response> {
    let reply: Reply = serde_json::from_str(text).map_err(Problem::internal)?;
    let mut response = reply.into_response();
    response.headers_mut().insert("idempotency-replayed", HeaderValue::from_static("true"));
    Ok(response)
}

fn in_progress() -> Problem {
    Problem::new(
        StatusCode::CONFLICT,
        "a request with this Idempotency-Key is being carried out; repeat it in a moment",
    )
}

fn mismatch() -> Problem {
    let detail =
        "this Idempotency-Key was used for another request; use a new key for a new request";
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, detail)
}
