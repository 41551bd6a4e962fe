//! One error for everything the store refuses or cannot do; each variant maps to one kind of HTTP problem.

use crate::objects::ObjectsError;

/// What an operation of the store returns.
pub type Result<T, E = StoreError> = std::result::Result<T, E>;

/// Why the store did not do it.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// There is no such thing, or it was deleted (404).
    #[error("there is no {kind} `{id}`")]
    NotFound {
        /// What was looked for: `ship`, `version`, ...
        kind: &'static str,
        /// The name or id that was asked for.
        id: String,
    },
    /// The request contradicts what is already there (409).
    #[error("{kind} `{id}`: {message}")]
    Conflict {
        /// What it concerns.
        kind: &'static str,
        /// Its name or id.
        id: String,
        /// What stands in the way.
        message: String,
    },
    /// The caller has seen an older state than the present one (412).
    #[error("{kind} `{id}` is at {}, not where the request expects it", at(*current))]
    PreconditionFailed {
        /// What it concerns.
        kind: &'static str,
        /// Its name or id.
        id: String,
        /// The revision it is at now; none when it does not exist.
        current: Option<i64>,
    },
    /// A value that no database of ours may hold (422).
    #[error("{field}: {message}")]
    Invalid {
        /// The field at fault.
        field: &'static str,
        /// What is wrong with it.
        message: String,
    },
    /// The database failed (500 or 503).
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// A file or folder of a backup cannot be used (500).
    #[error("{}: {error}", path.display())]
    File {
        /// The file or folder.
        path: std::path::PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// The object store failed, or an object is not what was put there (500).
    #[error("objects: {0}")]
    Objects(#[from] ObjectsError),
}

fn at(current: Option<i64>) -> String {
    current.map_or_else(|| "no revision (it does not exist)".to_owned(), |revision| format!("revision {revision}"))
}

impl StoreError {
    pub(crate) fn missing(kind: &'static str, id: impl Into<String>) -> Self {
        Self::NotFound { kind, id: id.into() }
    }

    pub(crate) fn conflict(kind: &'static str, id: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Conflict { kind, id: id.into(), message: message.into() }
    }

    pub(crate) fn stale(kind: &'static str, id: impl Into<String>, current: Option<i64>) -> Self {
        Self::PreconditionFailed { kind, id: id.into(), current }
    }

    pub(crate) fn invalid(field: &'static str, message: impl Into<String>) -> Self {
        Self::Invalid { field, message: message.into() }
    }
}
