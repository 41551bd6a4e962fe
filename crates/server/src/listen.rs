//! Taking connections: bounded in number, in the time for headers, and in the time to end.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::{GracefulShutdown, Watcher};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use crate::config::Limits;
use crate::stopping::Stopping;

/// Headers of one request.
const MAX_HEADERS: usize = 100;
/// What a connection may buffer before the body.
const HEAD_BYTES: usize = 64 << 10;
/// A pause when the system has no more sockets.
const BREATH: Duration = Duration::from_millis(100);

/// Serves until it is told to stop, then lets what is under way end.
pub(crate) async fn listen(listener: TcpListener, router: Router, limits: Limits, mut stopping: Stopping) {
    let server = Server { router, limits, graceful: GracefulShutdown::new() };
    let seats = Arc::new(Semaphore::new(limits.connections));
    loop {
        tokio::select! {
            () = stopping.wait() => break,
            taken = take(&listener, &seats) => match taken {
                Some((stream, seat)) => server.serve(stream, seat),
                None => tokio::time::sleep(BREATH).await,
            },
        }
    }
    drop(listener);
    if tokio::time::timeout(limits.stop_time, server.graceful.shutdown()).await.is_err() {
        tracing::warn!("connections were cut: they did not end in time");
    }
}

/// The next connection, once there is a seat for it.
async fn take(listener: &TcpListener, seats: &Arc<Semaphore>) -> Option<(TcpStream, OwnedSemaphorePermit)> {
    let seat = Arc::clone(seats).acquire_owned().await.ok()?;
    match listener.accept().await {
        Ok((stream, _)) => Some((stream, seat)),
        Err(error) => {
            tracing::warn!(%error, "a connection could not be taken");
            None
        }
    }
}

struct Server {
    router: Router,
    limits: Limits,
    graceful: GracefulShutdown,
}

impl Server {
    fn serve(&self, stream: TcpStream, seat: OwnedSemaphorePermit) {
        let watcher = self.graceful.watcher();
        tokio::spawn(connection(stream, self.router.clone(), self.limits.header_time, watcher, seat));
    }
}

async fn connection(stream: TcpStream, router: Router, header_time: Duration, watcher: Watcher, seat: OwnedSemaphorePermit) {
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "no TCP_NODELAY");
    }
    let mut builder = http1::Builder::new();
    builder.timer(TokioTimer::new()).header_read_timeout(header_time).max_headers(MAX_HEADERS).max_buf_size(HEAD_BYTES);
    let served = builder.serve_connection(TokioIo::new(stream), TowerToHyperService::new(router));
    if let Err(error) = watcher.watch(served).await {
        tracing::debug!(%error, "a connection broke off");
    }
    drop(seat);
}
