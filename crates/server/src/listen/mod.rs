//! Taking connections: bounded in number, in the time for heads, bodies and answers by their progress, and in the time to end.

mod address;
mod body;
mod connection;
mod pace;
mod seats;
mod stream;

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper_util::server::graceful::GracefulShutdown;
use tokio::net::{TcpListener, TcpSocket, TcpStream};

use crate::config::Limits;
use crate::stopping::Stopping;
use connection::Connection;
use seats::Seats;

pub(crate) use address::party;
pub(crate) use connection::Peer;

/// Connections that the system holds until they are taken.
const BACKLOG: u32 = 1024;
/// What the system keeps of an answer that is not read. It also is how finely reading is seen: the system tells of room only
/// when a third of this has been read.
const SEND_BUFFER: u32 = 128 << 10;
/// What the system takes of an answer beyond what is on its way to a reader. Answers that nobody reads are made no further
/// than that: 600 connections with 400 requests each would have had the work of ten times as many done for nothing.
#[cfg(any(target_os = "linux", target_os = "android"))]
const NOT_SENT: u32 = 16 << 10;
/// A pause when the system has no more sockets.
const BREATH: Duration = Duration::from_millis(100);
/// Descriptors for all but connections: database, samples, uploads, the log.
const OTHER_DESCRIPTORS: usize = 128;

/// Takes an address.
pub(crate) fn bind(listen: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = if listen.is_ipv4() { TcpSocket::new_v4() } else { TcpSocket::new_v6() }?;
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(SEND_BUFFER)?;
    socket.bind(listen)?;
    socket.listen(BACKLOG)
}

/// Descriptors that a server with these limits needs.
pub(crate) fn descriptors(limits: &Limits) -> usize {
    limits.connections + seats::RESERVE + OTHER_DESCRIPTORS
}

/// Serves until it is told to stop, then lets what is under way end.
pub(crate) async fn listen(listener: TcpListener, router: Router, limits: Limits, mut stopping: Stopping) {
    let server = Server { router, limits, graceful: GracefulShutdown::new(), seats: Seats::new(&limits) };
    loop {
        tokio::select! {
            () = stopping.wait() => break,
            taken = listener.accept() => match taken {
                Ok((stream, from)) => server.serve(stream, from),
                Err(error) => server.lacks(&error).await,
            },
        }
    }
    drop(listener);
    if tokio::time::timeout(limits.stop_time, server.graceful.shutdown()).await.is_err() {
        tracing::warn!("connections were cut: they did not end in time");
        server.seats.clear();
    }
}

/// Sends what there is at once, and takes no more than can be sent soon.
fn prepare(stream: &TcpStream) -> std::io::Result<()> {
    #[cfg(any(target_os = "linux", target_os = "android"))]
    socket2::SockRef::from(stream).set_tcp_notsent_lowat(NOT_SENT)?;
    stream.set_nodelay(true)
}

struct Server {
    router: Router,
    limits: Limits,
    graceful: GracefulShutdown,
    seats: Arc<Seats>,
}

impl Server {
    fn serve(&self, stream: TcpStream, from: SocketAddr) {
        if let Err(error) = prepare(&stream) {
            tracing::debug!(%error, "no TCP_NODELAY or TCP_NOTSENT_LOWAT");
        }
        match Connection::new(self, party(from.ip())) {
            Some(connection) => drop(tokio::spawn(connection.serve(stream, self.graceful.watcher()))),
            None => tracing::debug!("a connection was not taken: all others are at work"),
        }
    }

    /// A connection could not be taken: one that waits makes room for it, or some time passes.
    async fn lacks(&self, error: &std::io::Error) {
        tracing::warn!(%error, "a connection could not be taken");
        if !self.seats.spare() {
            tokio::time::sleep(BREATH).await;
        }
        tokio::task::yield_now().await;
    }
}
