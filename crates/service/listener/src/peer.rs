//! Connection of a request, as an extension of the request.

use std::net::IpAddr;
use std::sync::Arc;

use crate::progress::ConnectionProgress;
use crate::slots::Permit;

/// Paths that are answered even without a permit.
const HEALTH: [&str; 2] = ["/healthz", "/readyz"];

/// Connection of a request.
#[derive(Clone)]
pub struct PeerInfo {
    /// Address of the other end.
    pub address: IpAddr,
    /// Progress of the connection.
    pub(crate) pace: Arc<ConnectionProgress>,
    /// Permit of the connection, held as long as this value.
    pub(crate) _seat: Arc<Permit>,
    /// True if there is no free connection: the request is refused, unless it is a health check.
    pub crowded: bool,
}

/// Returns true if a path is a health check.
pub fn is_health(path: &str) -> bool {
    HEALTH.contains(&path)
}

impl PeerInfo {
    /// Returns true if the connection is closed because its body was sent, or its answer read, too
    /// slowly.
    #[must_use]
    pub fn is_too_slow(&self) -> bool {
        self.pace.is_too_slow()
    }

    /// Waits until the connection must be closed in favour of others; for handlers that keep it
    /// after the answer, such as a WebSocket.
    pub async fn until_cut(&self) {
        self.pace.until_cut().await;
    }

    /// Records that the server works for a kept connection.
    pub fn mark_working(&self) {
        self.pace.begin_request();
    }

    /// Records that the server waits for the other end.
    pub fn mark_waiting(&self) {
        self.pace.end_answer();
    }
}
