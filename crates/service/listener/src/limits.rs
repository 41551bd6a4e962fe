//! Bounds on connections.

use std::time::Duration;

/// Bounds on connections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConnectionLimits {
    /// Maximum time to read the head of a request.
    pub header_time: Duration,
    /// Maximum number of connections; while all of them are busy, further ones are refused.
    pub connections: usize,
    /// Maximum number of connections of one address (for IPv6: of a network of 64 bits).
    pub connections_per_address: usize,
    /// Minimum average rate of a request's body and of the reader of an answer, bytes per second.
    /// It is far below any link in use: a satellite terminal for ships has 2400 bit/s and more.
    pub least_rate: usize,
    /// Time without a byte of a body after which it is given up; bytes above the minimum rate
    /// extend it, up to a minute.
    pub body_grace: Duration,
    /// The same for answers; longer, because the system reports reading in steps of tens of
    /// kilobytes.
    pub answer_grace: Duration,
    /// Maximum time for requests in progress when the server stops.
    pub stop_time: Duration,
}

impl Default for ConnectionLimits {
    fn default() -> Self {
        Self {
            header_time: Duration::from_secs(10),
            connections: 1024,
            connections_per_address: 512,
            least_rate: 256,
            body_grace: Duration::from_secs(10),
            answer_grace: Duration::from_secs(60),
            stop_time: Duration::from_secs(10),
        }
    }
}
