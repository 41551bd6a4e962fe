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
use sistership_listener::Peer;
use sistership_web_support::host;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::sessions::found;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{Acting, current};
use crate::web::payload::from_slice;
use crate::web::{Id, Place};

/// Longest message, bytes.
const MESSAGE: usize = 64 << 10;
/// Number of steps that are simulated before the first of them is sent.
const TOGETHER: usize = 64;
/// Longest duration of a stream, which keeps the roles of its opening.
const LONGEST: Duration = Duration::from_secs(3600);

pub(super) fn routes() -> OpenApiRouter<App> {
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
    responses((status = 101, description = "The protocol is a WebSocket's now"))
)]
async fn stream(
    State(app): State<App>,
    Place(id): Place<Id>,
    headers: HeaderMap,
    peer: Option<Extension<Peer>>,
    upgrade: std::result::Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Result<Response> {
    of_no_other_site(&headers)?;
    found(&app, &id).await?;
    let upgrade = upgrade.map_err(|error| {
        Problem::bad_request(format!("this is to be opened as a WebSocket: {error}"))
    })?;
    let acting = current().ok_or_else(|| Problem::internal("nobody is named who asks"))?;
    let upgrade = upgrade.max_message_size(MESSAGE).max_frame_size(MESSAGE);
    let peer = peer.map(|Extension(peer)| peer);
    Ok(upgrade.on_upgrade(move |socket| async move {
        let served = Served { app, id: id.into_string(), acting };
        drop(tokio::time::timeout(LONGEST, served.serve(socket, peer)).await);
    }))
}

/// Refuses WebSockets that pages of other sites open: browsers send the site as `Origin`, and do
/// not ask the server for permission first.
fn of_no_other_site(headers: &HeaderMap) -> Result<()> {
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok());
    let host: Option<Authority> = host.and_then(|host| host.parse().ok());
    if headers.contains_key(header::ORIGIN) && !host::is_same_origin(headers, host.as_ref())? {
        let why = "another web site may not open a stream of this server";
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    Ok(())
}

/// Session and caller of a stream.
struct Served {
    app: App,
    id: String,
    acting: Acting,
}

impl Served {
    async fn serve(&self, mut socket: WebSocket, peer: Option<Peer>) {
        let mut stopping = self.app.stopping();
        loop {
            let came = tokio::select! {
                () = stopping.wait() => break,
                () = cut(peer.as_ref()) => break,
                came = socket.recv() => came,
            };
            let text = match came {
                Some(Ok(Message::Text(text))) => text,
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                _ => break,
            };
            peer.iter().for_each(Peer::works);
            let answered = self.acting.clone().scope(self.steps(text.as_bytes(), &mut socket));
            if self.app.held().scope(answered).await.is_err() {
                break;
            }
            peer.iter().for_each(Peer::waits);
        }
        // The other side may be gone already, so that an error is ignored.
        drop(socket.send(Message::Close(None)).await);
    }

    /// Simulates the steps that a message requests.
    ///
    /// # Errors
    /// Returns an error if the socket is closed.
    async fn steps(&self, text: &[u8], socket: &mut WebSocket) -> Result<(), axum::Error> {
        let request = match from_slice::<StepsRequest>(text) {
            Ok(request) => Arc::new(request),
            Err(problem) => return send(socket, &problem).await,
        };
        let mut sailed = 0;
        // Few steps at a time: the first arrive early, and other sessions get their turn.
        loop {
            let (rows, ended) = match self.rows(&request, sailed).await {
                Ok(some) => some,
                Err(problem) => return send(socket, &problem).await,
            };
            sailed += rows.len();
            for row in &rows {
                send(socket, row).await?;
            }
            if ended {
                return Ok(());
            }
        }
    }

    /// Returns the next of the requested steps, and whether they are the last.
    async fn rows(&self, request: &Arc<StepsRequest>, sailed: usize) -> Result<(Vec<Value>, bool)> {
        // The caller's role for the ship is checked again in each batch.
        let (handle, request) = (found(&self.app, &self.id).await?, Arc::clone(request));
        let most = self.app.limits().prediction_samples;
        let sail = move || handle.with(|session| session.rows(&request, sailed, TOGETHER, most));
        Ok(self.app.compute(sail).await??)
    }
}

async fn cut(peer: Option<&Peer>) {
    match peer {
        Some(peer) => peer.until_cut().await,
        None => std::future::pending().await,
    }
}

async fn send(socket: &mut WebSocket, value: &impl serde::Serialize) -> Result<(), axum::Error> {
    let text = serde_json::to_string(value).map_err(axum::Error::new)?;
    socket.send(Message::Text(text.into())).await
}
