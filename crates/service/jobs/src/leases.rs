//! Leases of workers on jobs.

use std::time::Duration;

/// Durations of the leases of workers on jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LeaseSettings {
    /// Time without a heartbeat after which another worker may take the job.
    pub lease: Duration,
    /// Interval of heartbeats.
    pub beat: Duration,
    /// Interval at which an idle worker polls for jobs queued by other processes.
    pub poll: Duration,
    /// Time for which a worker that is stopped continues its job before it returns it to the queue.
    pub drain: Duration,
}

impl LeaseSettings {
    /// Longest lease.
    pub const MAX: Duration = Duration::from_secs(3600);

    /// Longest time that stopping may wait for jobs.
    pub const MAX_DRAIN: Duration = Duration::from_secs(24 * 3600);

    /// Returns the durations for a lease with five heartbeats in it: four may be missed before the
    /// job is lost.
    pub fn with_lease(lease: Duration) -> Self {
        Self {
            lease,
            beat: lease / 5,
            poll: Duration::from_millis(500),
            drain: Duration::from_secs(20),
        }
    }
}

impl Default for LeaseSettings {
    fn default() -> Self {
        Self::with_lease(Duration::from_secs(15))
    }
}
