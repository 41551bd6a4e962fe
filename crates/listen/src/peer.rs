//! What a request's connection says of it.

use std::net::IpAddr;
use std::sync::Arc;

use crate::pace::Pace;

/// What answers even where there is no seat for a request.
const HEALTH: [&str; 2] = ["/healthz", "/readyz"];

/// What a request's connection says of it.
#[derive(Clone)]
pub struct Peer {
    /// Whom it comes from.
    pub party: IpAddr,
    /// How its connection gets on.
    pub(crate) pace: Arc<Pace>,
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
}
