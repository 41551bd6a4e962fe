//! A ship under way over a WebSocket: each message asks for steps, each step is a message.

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

/// The longest message, bytes.
const MESSAGE: usize = 64 << 10;
/// Steps that are sailed before the first of them is sent.
const TOGETHER: usize = 64;
/// A stream goes on with the roles that opened it had: no longer than this.
const LONGEST: Duration = Duration::from_secs(3600);

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(stream))
}

/// Sail on over a WebSocket
///
/// Each text message is the body of `POST /v1/sessions/{id}/steps`; each step is answered by a
/// message as `GET /v1/sessions/{id}` shows it, and what cannot be by one with the problem. Where
/// the motion has left the physical range, one message with `stopped` ends the steps. The stream
/// ends with the session, and after an hour.
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

/// A browser tells the site that opens a WebSocket, and asks nobody whether it may.
fn of_no_other_site(headers: &HeaderMap) -> Result<()> {
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok());
    let host: Option<Authority> = host.and_then(|host| host.parse().ok());
    if headers.contains_key(header::ORIGIN) && !host::is_same_origin(headers, host.as_ref())? {
        let why = "another web site may not open a stream of this server";
        return Err(Problem::new(StatusCode::FORBIDDEN, why));
    }
    Ok(())
}

/// Whom a stream serves.
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
        // Who does not listen any longer need not be told.
        drop(socket.send(Message::Close(None)).await);
    }

    /// Sails what a message asks for; an error is that the socket is gone.
    async fn steps(&self, text: &[u8], socket: &mut WebSocket) -> Result<(), axum::Error> {
        let request = match from_slice::<StepsRequest>(text) {
            Ok(request) => Arc::new(request),
            Err(problem) => return send(socket, &problem).await,
        };
        let mut sailed = 0;
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

    /// The next steps of those asked for, and whether they are the last.
    async fn rows(&self, request: &Arc<StepsRequest>, sailed: usize) -> Result<(Vec<Value>, bool)> {
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
