//! A job as it is kept, and what it is made of.

use std::fmt;
use std::str::FromStr;

use crate::error::{Result, StoreError};
use crate::record::{StoredColumn, record};

/// The columns of a job, for every text that reads one.
macro_rules! job {
    ($before:literal, $after:literal) => {
        concat!(
            $before,
            " id, kind, ship, request, state, progress, message, result, error, attempt, fence, \
             lease_until_us, worker, created_us, started_us, finished_us, cancel_requested, \
             lost_workers, author ",
            $after
        )
    };
}
pub(crate) use job;

/// Where a job stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobState {
    /// Waiting for a worker.
    Queued,
    /// A worker holds it.
    Running,
    /// Done.
    Succeeded,
    /// Given up.
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

    /// Whether nothing more will happen to the job by itself.
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
    /// A piece of long work.
    pub struct Job {
        /// Its id.
        pub id: String,
        /// What is to be done: `refinement`, `diagnosis`, ...
        pub kind: String,
        /// The ship it concerns, if it concerns one.
        pub ship: Option<String>,
        /// What was asked, JSON.
        pub request: String,
        /// Where it stands.
        pub state: JobState,
        /// How much is done, from 0 to 1.
        pub progress: f64,
        /// What is being done.
        pub message: String,
        /// What came of it, JSON.
        pub result: Option<String>,
        /// Why it failed.
        pub error: Option<String>,
        /// How often it has been begun.
        pub attempt: i64,
        /// Raised by each claim.
        pub fence: i64,
        /// Until when its worker holds it.
        pub lease_until_us: Option<i64>,
        /// The worker that holds or held it.
        pub worker: Option<String>,
        /// When it was asked for.
        pub created_us: i64,
        /// When it was first begun.
        pub started_us: Option<i64>,
        /// When it came to an end.
        pub finished_us: Option<i64>,
        /// Whether its worker is asked to stop.
        pub cancel_requested: bool,
        /// How many of its workers have let their lease run out without a word, as a process does
        /// that has ended.
        pub lost_workers: i64,
        /// Who asked for it; none where it was asked for before that was kept.
        pub author: Option<String>,
    }
}

record! {
    /// Jobs of one kind in one state.
    pub struct JobCount {
        /// The kind.
        pub kind: String,
        /// The state.
        pub state: JobState,
        /// How many there are.
        pub jobs: i64,
        /// When the oldest of them was asked for.
        pub oldest_us: i64,
    }
}

/// What a job is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewJob {
    /// What is to be done.
    pub kind: String,
    /// The ship it concerns, if it concerns one.
    pub ship: Option<String>,
    /// What is asked, JSON.
    pub request: String,
}

/// Which jobs to list.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct JobFilter {
    /// Of this ship only.
    pub ship: Option<String>,
    /// In this state only.
    pub state: Option<JobState>,
}
