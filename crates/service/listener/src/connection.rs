//! One connection: HTTP/1 over a monitored stream.

use std::net::IpAddr;
use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::Request;
use axum::http::header;
use axum::response::Response;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service as _, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::Watcher;
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpStream;

use crate::address::counted_address;
use crate::body::{RequestBody, ResponseBody, UnreadBody};
use crate::limits::ConnectionLimits;
use crate::peer::{PeerInfo, is_health};
use crate::progress::ConnectionProgress;
use crate::slots::{ConnectionSlots, Permit};
use crate::stop_signal::StopSignal;
use crate::stream::WatchedStream;

/// Maximum number of headers of a request.
const MAX_HEADERS: usize = 100;
/// Maximum size of the head of a request, bytes.
const HEAD_BYTES: usize = 32 << 10;

/// A connection with a permit.
pub(super) struct ClientConnection {
    router: Router,
    limits: ConnectionLimits,
    address: IpAddr,
    pace: Arc<ConnectionProgress>,
    seat: Arc<Permit>,
}

impl ClientConnection {
    pub(super) fn new(
        router: &Router,
        limits: ConnectionLimits,
        seats: &Arc<ConnectionSlots>,
        address: IpAddr,
    ) -> Option<Self> {
        let pace = Arc::new(ConnectionProgress::new(&limits));
        let seat = Arc::new(ConnectionSlots::admit(seats, counted_address(address), &pace)?);
        Some(Self { router: router.clone(), limits, address, pace, seat })
    }

    pub(super) async fn serve(self, stream: TcpStream, watcher: Watcher, mut stopping: StopSignal) {
        let stream = WatchedStream::new(stream, Arc::clone(&self.pace));
        let mut builder = http1::Builder::new();
        builder.timer(TokioTimer::new()).header_read_timeout(self.limits.header_time);
        builder.max_headers(MAX_HEADERS).max_buf_size(HEAD_BYTES);
        let connection = Arc::new(self);
        let serving = Arc::clone(&connection);
        let service = service_fn(move |request| Arc::clone(&serving).answer_request(request));
        let served = builder.serve_connection(TokioIo::new(stream), service).with_upgrades();
        let mut served = std::pin::pin!(served);
        let mut told = false;
        loop {
            tokio::select! {
                served = served.as_mut() => {
                    if let Err(error) = served {
                        tracing::debug!(%error, "a connection was interrupted");
                    }
                    break;
                }
                // Requests in progress are still answered; the branch is disabled after its first
                // use.
                () = stopping.wait(), if !told => {
                    told = true;
                    served.as_mut().graceful_shutdown();
                }
                () = connection.pace.until_cut() => {
                    tracing::debug!("an idle connection was closed to admit others");
                    break;
                }
            }
        }
        // The shutdown waits for this: a connection that can be upgraded cannot be watched itself.
        drop(watcher);
    }

    async fn answer_request(
        self: Arc<Self>,
        request: Request<Incoming>,
    ) -> hyper::Result<Response<ResponseBody>> {
        // Pipelined requests are answered only as fast as the client reads.
        self.pace.until_read().await;
        self.pace.begin_request();
        // Health checks are answered without a permit; other requests wait a while for one.
        let crowded = !is_health(request.uri().path()) && !self.seat.wait_for_permit().await;
        // A client that sent `Expect` waits for the word to continue and has sent no body.
        let waits = request.headers().contains_key(header::EXPECT);
        let (pace, rest) = (Arc::clone(&self.pace), UnreadBody::default());
        let mut request =
            request.map(|body| Body::new(RequestBody::new(body, Arc::clone(&pace), rest.clone())));
        request.extensions_mut().insert(PeerInfo {
            address: self.address,
            pace: Arc::clone(&pace),
            _seat: Arc::clone(&self.seat),
            crowded,
        });
        let answered = TowerToHyperService::new(self.router.clone()).call(request).await;
        let response = answered.unwrap_or_else(|never| match never {});
        // The unread rest is discarded before the answer is sent, otherwise the client may see a
        // reset.
        if !(crowded || waits || pace.is_too_slow()) {
            pace.awaits_body();
            rest.discard().await;
            pace.record_received(0);
        }
        Ok(response.map(|body| ResponseBody::new(body, pace)))
    }
}
