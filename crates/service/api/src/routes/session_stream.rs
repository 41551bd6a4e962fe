//! Simulation sessions over a WebSocket: each message requests steps, each step is a message.

use std::sync::Arc;
use std::time::Duration;

use axum::Extension;
use axum::extract::State;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::Response;
use serde_json::Value;
use sistership_jobs::predictions::session::StepsRequest;
use sistership_listener::PeerInfo;
use sistership_web_support::host;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::sessions::find_session;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{RequestActor, current_actor};
use crate::web::payload::from_slice;
use crate::web::{Id, PathParams};

/// Longest message, bytes.
const MESSAGE_BYTES: usize = 64 << 10;
/// Number of steps that are simulated before the first of them is sent.
const STEPS_PER_BATCH: usize = 64;
/// Longest duration of a stream, which keeps the roles of its opening.
const LONGEST_STREAM: Duration = Duration::from_secs(3600);

pub(super) fn stream_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(stream))
}

/// Advance a session over a WebSocket
///
/// Each text message is a body of `POST /v1/sessions/{id}/steps`; each step is answered by a
/// message as `GET /v1/sessions/{id}` shows it, and an invalid request by a message with the
/// problem. If the motion has left the physical range, one message with `stopped` ends the steps.
/// The stream ends with the session, and after an hour.
#[utoipa::path(
    get, path = "/v1/sessions/{id}/stream", tag = "predictions", params(("id" = inline(Id), Path)),
    responses((status = 101, description = "The protocol changes to WebSocket"))
)]
async fn stream(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    headers: HeaderMap,
    peer: Option<Extension<PeerInfo>>,
    upgrade: std::result::Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Result<Response> {
    check_same_site(&headers)?;
    find_session(&app, &id).await?;
    let upgrade = upgrade.map_err(|error| {
        Problem::bad_request(format!("open this address as a WebSocket: {error}"))
    })?;
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    let upgrade = upgrade.max_message_size(MESSAGE_BYTES).max_frame_size(MESSAGE_BYTES);
    let peer = peer.map(|Extension(peer)| peer);
    Ok(upgrade.on_upgrade(move |socket| async move {
        let served = SessionStream { app, id: id.into_string(), acting };
        drop(tokio::time::timeout(LONGEST_STREAM, served.run(socket, peer)).await);
    }))
}

/// Refuses WebSockets that pages of other sites open: browsers send the site as `Origin`, and do
/// not ask the server for permission first.
fn check_same_site(headers: &HeaderMap) -> Result<()> {
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok());
    let host: Option<Authority> = host.and_then(|host| host.parse().ok());
    if headers.contains_key(header::ORIGIN) && !host::is_same_origin(headers, host.as_ref())? {
        let why = "a page of another web site may not open a stream of this server";
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    Ok(())
}

/// Session and caller of a stream.
struct SessionStream {
    app: App,
    id: String,
    acting: RequestActor,
}

impl SessionStream {
    async fn run(&self, mut socket: WebSocket, peer: Option<PeerInfo>) {
        let mut stopping = self.app.stop_signal();
        loop {
            let came = tokio::select! {
                () = stopping.wait() => break,
                () = wait_until_cut(peer.as_ref()) => break,
                came = socket.recv() => came,
            };
            let text = match came {
                Some(Ok(Message::Text(text))) => text,
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                _ => break,
            };
            peer.iter().for_each(PeerInfo::mark_working);
            let answered =
                self.acting.clone().run_scoped(self.answer_steps(text.as_bytes(), &mut socket));
            if self.app.request_memory().run_async(answered).await.is_err() {
                break;
            }
            peer.iter().for_each(PeerInfo::mark_waiting);
        }
        // The other side may be gone already, so that an error is ignored.
        drop(socket.send(Message::Close(None)).await);
    }

    /// Simulates the steps that a message requests.
    ///
    /// # Errors
    /// Returns an error if the socket is closed.
    async fn answer_steps(&self, text: &[u8], socket: &mut WebSocket) -> Result<(), axum::Error> {
        let request = match from_slice::<StepsRequest>(text) {
            Ok(request) => Arc::new(request),
            Err(problem) => return send_json(socket, &problem).await,
        };
        let mut sailed = 0;
        // Few steps at a time: the first arrive early, and other sessions get their turn.
        loop {
            let (rows, ended) = match self.next_rows(&request, sailed).await {
                Ok(some) => some,
                Err(problem) => return send_json(socket, &problem).await,
            };
            sailed += rows.len();
            for row in &rows {
                send_json(socket, row).await?;
            }
            if ended {
                return Ok(());
            }
        }
    }

    /// Returns the next of the requested steps, and whether they are the last.
    async fn next_rows(
        &self,
        request: &Arc<StepsRequest>,
        sailed: usize,
    ) -> Result<(Vec<Value>, bool)> {
        // The caller's role for the ship is checked again in each batch.
        let (handle, request) = (find_session(&self.app, &self.id).await?, Arc::clone(request));
        let most = self.app.limits().prediction_samples;
        let sail = move || {
            handle.with_session(|session| {
                session.simulate_rows(&request, sailed, STEPS_PER_BATCH, most)
            })
        };
        Ok(self.app.run_blocking(sail).await??)
    }
}

async fn wait_until_cut(peer: Option<&PeerInfo>) {
    match peer {
        Some(peer) => peer.until_cut().await,
        None => std::future::pending().await,
    }
}

async fn send_json(
    socket: &mut WebSocket,
    value: &impl serde::Serialize,
) -> Result<(), axum::Error> {
    let text = serde_json::to_string(value).map_err(axum::Error::new)?;
    socket.send(Message::Text(text.into())).await
}
