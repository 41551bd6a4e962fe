//! How workers hold their jobs.

use std::time::Duration;

/// How workers hold their jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leases {
    /// After this long without a beat, another worker may take the job.
    pub lease: Duration,
    /// How often a worker tells that it lives.
    pub beat: Duration,
    /// How often an idle worker looks for jobs that other processes have queued.
    pub poll: Duration,
    /// How long a worker that is told to stop goes on with its job before it gives it back.
    pub drain: Duration,
}

impl Leases {
    /// The longest that a lease may be.
    pub const MAX: Duration = Duration::from_secs(3600);

    /// The longest that stopping may wait for jobs.
    pub const MAX_DRAIN: Duration = Duration::from_secs(24 * 3600);

    /// A lease of a length, with five beats in it: four may be missed before the job is lost.
    pub fn of(lease: Duration) -> Self {
        Self {
            lease,
            beat: lease / 5,
            poll: Duration::from_millis(500),
            drain: Duration::from_secs(20),
        }
    }
}

impl Default for Leases {
    fn default() -> Self {
        Self::of(Duration::from_secs(15))
    }
}
