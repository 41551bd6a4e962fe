//! What a request's connection says of it.

use std::net::IpAddr;
use std::sync::Arc;

use crate::pace::Pace;
use crate::seats::Seat;

/// What answers even where there is no seat for a request.
const HEALTH: [&str; 2] = ["/healthz", "/readyz"];

/// What a request's connection says of it.
#[derive(Clone)]
pub struct Peer {
    /// The other end of the connection.
    pub address: IpAddr,
    /// How its connection gets on.
    pub(crate) pace: Arc<Pace>,
    /// Its connection's place, which is kept while this is.
    pub(crate) _seat: Arc<Seat>,
    /// There is no seat for it: it is refused, unless it asks for health.
    pub crowded: bool,
}

/// Whether a path tells of health.
pub fn is_health(path: &str) -> bool {
    HEALTH.contains(&path)
}

impl Peer {
    /// Whether its connection is cut because its body or its reading came too slowly.
    #[must_use]
    pub fn is_too_slow(&self) -> bool {
        self.pace.is_too_slow()
    }

    /// Waits until its connection has to give way to others; for whoever keeps it after the answer,
    /// as a WebSocket does.
    pub async fn until_cut(&self) {
        self.pace.until_cut().await;
    }

    /// The server has something to do for whoever keeps the connection.
    pub fn works(&self) {
        self.pace.begin();
    }

    /// The server waits for the other end.
    pub fn waits(&self) {
        self.pace.end();
    }
}
