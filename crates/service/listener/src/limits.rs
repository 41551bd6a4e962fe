//! Bounds on connections.

use std::time::Duration;

/// Bounds on connections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Until a request's head has been read.
    pub header_time: Duration,
    /// Connections at a time; where they are all at work, further ones are refused.
    pub connections: usize,
    /// Connections of one address at a time (of IPv6: of a network of 64 bits).
    pub connections_per_address: usize,
    /// Bytes a second, on average, that a request's body must bring and a reader of an answer must
    /// take. Long below any link in use: a satellite terminal for ships has 2400 bit/s and more.
    pub least_rate: usize,
    /// Without a byte of a body until it is given up; what comes faster than it must earns more, up
    /// to a minute.
    pub body_grace: Duration,
    /// The same for answers. Longer, as the system tells of reading by tens of kilobytes.
    pub answer_grace: Duration,
    /// How long a server that is told to stop waits for what is under way.
    pub stop_time: Duration,
}

impl Default for Limits {
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
