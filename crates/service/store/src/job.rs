//! Jobs as rows, and the input from which they are created.

use std::fmt;
use std::str::FromStr;

use crate::error::{Result, StoreError};
use crate::record::{StoredColumn, record};

/// Columns of a job, for every statement that returns one.
macro_rules! job {
    ($before:literal, $after:literal) => {
        concat!(
            $before,
            " id, kind, ship, request, state, progress, message, result, error, attempt, fence, \
             lease_until_us, worker, created_us, started_us, finished_us, cancel_requested, \
             lost_workers, author, small, trace_parent ",
            $after
        )
    };
}
pub(crate) use job;

/// State of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobState {
    /// Waiting for a worker.
    Queued,
    /// Held by a worker.
    Running,
    /// Completed with a result.
    Succeeded,
    /// Ended with an error.
    Failed,
    /// Stopped on request.
    Cancelled,
}

impl JobState {
    const ALL: [Self; 5] =
        [Self::Queued, Self::Running, Self::Succeeded, Self::Failed, Self::Cancelled];

    /// Its name, as it is stored and shown.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Running => "running",
            Self::Succeeded => "succeeded",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }

    /// Returns true if the job has ended: its state changes no more by itself.
    pub fn is_final(self) -> bool {
        !matches!(self, Self::Queued | Self::Running)
    }
}

impl fmt::Display for JobState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl FromStr for JobState {
    type Err = StoreError;

    fn from_str(name: &str) -> Result<Self> {
        let state = Self::ALL.into_iter().find(|state| state.as_str() == name);
        state.ok_or_else(|| StoreError::invalid("state", format!("there is no job state `{name}`")))
    }
}

impl StoredColumn for JobState {
    type Stored = String;

    fn load(stored: String) -> sqlx::Result<Self> {
        stored.parse().map_err(|error: StoreError| sqlx::Error::Decode(Box::new(error)))
    }
}

record! {
    /// A job: work that takes longer than a request.
    pub struct Job {
        /// Its id.
        pub id: String,
        /// Kind of work: `refinement`, `diagnosis`, ...
        pub kind: String,
        /// The ship it concerns, if it concerns one.
        pub ship: Option<String>,
        /// Request, JSON.
        pub request: String,
        /// State.
        pub state: JobState,
        /// Completed share, from 0 to 1.
        pub progress: f64,
        /// Present step, in words.
        pub message: String,
        /// Result, JSON; none before it has succeeded.
        pub result: Option<String>,
        /// Reason of the failure.
        pub error: Option<String>,
        /// Number of attempts.
        pub attempt: i64,
        /// Fencing number, raised by each claim.
        pub fence: i64,
        /// End of the lease of its worker, microseconds since 1970.
        pub lease_until_us: Option<i64>,
        /// The worker that holds or held it.
        pub worker: Option<String>,
        /// Time of the request, microseconds since 1970.
        pub created_us: i64,
        /// Start of the first attempt, microseconds since 1970.
        pub started_us: Option<i64>,
        /// End, microseconds since 1970.
        pub finished_us: Option<i64>,
        /// True if its worker is asked to stop.
        pub cancel_requested: bool,
        /// Number of its workers whose lease ran out without a heartbeat, as happens when a process
        /// dies.
        pub lost_workers: i64,
        /// Author of the request, as the audit names it.
        pub author: String,
        /// True for a job of seconds, which precedes large ones of its author.
        pub small: bool,
        /// W3C trace context of the request, if traces were exported.
        pub trace_parent: Option<String>,
    }
}

record! {
    /// Number of jobs of one kind in one state.
    pub struct JobCount {
        /// The kind.
        pub kind: String,
        /// The state.
        pub state: JobState,
        /// Number of jobs.
        pub jobs: i64,
        /// Time of the oldest request among them, microseconds since 1970.
        pub oldest_us: i64,
    }
}

/// A job to be queued.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewJob {
    /// Kind of work.
    pub kind: String,
    /// The ship it concerns, if it concerns one.
    pub ship: Option<String>,
    /// Request, JSON.
    pub request: String,
    /// True for a job of seconds, which precedes large ones of its author.
    pub small: bool,
}

/// Selection of jobs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct JobFilter {
    /// Jobs of this ship only.
    pub ship: Option<String>,
    /// Jobs in this state only.
    pub state: Option<JobState>,
}
