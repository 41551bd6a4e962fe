//! Acceptance of connections until the server stops.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper_util::server::graceful::GracefulShutdown;
use tokio::net::{TcpListener, TcpStream};

use crate::connection::ClientConnection;
use crate::limits::ConnectionLimits;
use crate::slots::ConnectionSlots;
use crate::stop_signal::StopSignal;

/// Bytes of an answer that the system accepts beyond those in flight. Answers that are not read are
/// produced no further: otherwise 600 connections with 400 requests each would have had the work of
/// ten times as many done for nothing.
#[cfg(any(target_os = "linux", target_os = "android"))]
const NOT_SENT: u32 = 16 << 10;
/// Delay before the next attempt when the system has no more sockets.
const RETRY_DELAY: Duration = Duration::from_millis(100);

/// Serves until the stop signal, then waits for the requests in progress.
pub async fn listen(
    listener: TcpListener,
    router: Router,
    limits: ConnectionLimits,
    mut stopping: StopSignal,
) {
    let server = ConnectionServer {
        router,
        limits,
        graceful: GracefulShutdown::new(),
        seats: ConnectionSlots::new(&limits),
        stopping: stopping.clone(),
    };
    loop {
        tokio::select! {
            // No new connections after the signal; those that exist are ended below.
            () = stopping.wait() => break,
            taken = listener.accept() => match taken {
                Ok((stream, from)) => server.serve(stream, from),
                Err(error) => server.handle_shortage(&error).await,
            },
        }
    }
    // Closed first: no connection is queued that would not be served.
    drop(listener);
    if tokio::time::timeout(limits.stop_time, server.graceful.shutdown()).await.is_err() {
        tracing::warn!("connections were closed at the deadline");
        server.seats.cut_all();
    }
}

/// Sets the options of a connection: data is sent without delay, and no more is accepted than can
/// be sent soon.
fn set_options(stream: &TcpStream) -> std::io::Result<()> {
    #[cfg(any(target_os = "linux", target_os = "android"))]
    socket2::SockRef::from(stream).set_tcp_notsent_lowat(NOT_SENT)?;
    stream.set_nodelay(true)
}

struct ConnectionServer {
    router: Router,
    limits: ConnectionLimits,
    graceful: GracefulShutdown,
    seats: Arc<ConnectionSlots>,
    stopping: StopSignal,
}

impl ConnectionServer {
    fn serve(&self, stream: TcpStream, from: SocketAddr) {
        if let Err(error) = set_options(&stream) {
            tracing::debug!(%error, "TCP_NODELAY or TCP_NOTSENT_LOWAT cannot be set");
        }
        match ClientConnection::new(&self.router, self.limits, &self.seats, from.ip()) {
            Some(connection) => drop(tokio::spawn(connection.serve(
                stream,
                self.graceful.watcher(),
                self.stopping.clone(),
            ))),
            None => tracing::debug!("a connection was refused: all connections are in use"),
        }
    }

    /// Handles a failed acceptance: closes a waiting connection, or pauses.
    async fn handle_shortage(&self, error: &std::io::Error) {
        tracing::warn!(%error, "a connection could not be accepted");
        if !self.seats.evict_longest() {
            tokio::time::sleep(RETRY_DELAY).await;
        }
        // Lets the closed connection release its socket before the next attempt.
        tokio::task::yield_now().await;
    }
}
