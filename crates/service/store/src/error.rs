//! The error of the store; each variant maps to one kind of HTTP problem.

use std::error::Error;
use std::io::{self, ErrorKind};

use crate::objects_error::ObjectsError;

/// Result of an operation of the store.
pub type Result<T, E = StoreError> = std::result::Result<T, E>;

/// Error of the store.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// There is no such thing, or it was deleted (404).
    #[error("there is no {kind} `{id}`")]
    NotFound {
        /// Kind of the missing item: `ship`, `version`, ...
        kind: &'static str,
        /// The name or id that was asked for.
        id: String,
    },
    /// The request contradicts what is already there (409).
    #[error("{kind} `{id}`: {message}")]
    Conflict {
        /// Kind of the item.
        kind: &'static str,
        /// Its name or id.
        id: String,
        /// Reason of the conflict.
        message: String,
    },
    /// The present actor may not do this (403).
    #[error("{message}")]
    Forbidden {
        /// Reason of the refusal, and the role that is allowed to do it.
        message: String,
    },
    /// The present actor has as many of these as it may have (429).
    #[error("{message}")]
    QuotaExceeded {
        /// The number, the limit, and how to get below it.
        message: String,
    },
    /// The caller has seen an older state than the present one (412).
    #[error(
        "{kind} `{id}` is at {}, which is not the revision that the request expects",
        revision_text(*current)
    )]
    PreconditionFailed {
        /// Kind of the item.
        kind: &'static str,
        /// Its name or id.
        id: String,
        /// Present revision; none if it does not exist.
        current: Option<i64>,
    },
    /// A value that cannot be stored (422).
    #[error("{field}: {message}")]
    Invalid {
        /// The field at fault.
        field: &'static str,
        /// Reason, and what would be right.
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
        /// Error of the operating system.
        error: std::io::Error,
    },
    /// The object store failed (503), or an object is not what was put there (500).
    #[error("objects: {0}")]
    Objects(#[from] ObjectsError),
}

fn revision_text(current: Option<i64>) -> String {
    current.map_or_else(
        || "no revision (it does not exist)".to_owned(),
        |revision| format!("revision {revision}"),
    )
}

impl StoreError {
    /// Returns true if there was no space left for the database or the objects: reads continue, and
    /// writes do so once there is space.
    pub fn is_out_of_space(&self) -> bool {
        match self {
            Self::Database(error) => is_full(error),
            Self::File { error, .. } => is_out_of_space(error),
            Self::Objects(error) => io_errors(error).any(is_out_of_space),
            _ => false,
        }
    }

    /// Returns true if the object store failed in a way that may pass, so that a retry is useful.
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Objects(error) if error.is_passing())
    }

    /// Returns true if stored data are missing or damaged: a retry gives the same result, and other
    /// data are not affected.
    pub fn is_data_fault(&self) -> bool {
        match self {
            Self::NotFound { .. } => true,
            Self::Objects(error) => matches!(error, ObjectsError::Damaged { .. }),
            _ => false,
        }
    }

    /// Returns the error of data that could not be stored for lack of space.
    pub fn out_of_space() -> Self {
        Self::Objects(ObjectsError::Folder(ErrorKind::StorageFull.into()))
    }

    /// Returns the error of a database or object store that did not answer, and may answer later.
    pub fn unanswered() -> Self {
        Self::Database(sqlx::Error::Io(ErrorKind::TimedOut.into()))
    }

    pub(crate) fn not_found(kind: &'static str, id: impl Into<String>) -> Self {
        Self::NotFound { kind, id: id.into() }
    }

    pub(crate) fn conflict(
        kind: &'static str,
        id: impl Into<String>,
        message: impl Into<String>,
    ) -> Self {
        Self::Conflict { kind, id: id.into(), message: message.into() }
    }

    pub(crate) fn precondition_failed(
        kind: &'static str,
        id: impl Into<String>,
        current: Option<i64>,
    ) -> Self {
        Self::PreconditionFailed { kind, id: id.into(), current }
    }

    pub(crate) fn invalid(field: &'static str, message: impl Into<String>) -> Self {
        Self::Invalid { field, message: message.into() }
    }
}

/// Codes of SQLite for lack of space: `SQLITE_FULL`, and failed writes, syncs and memory maps,
/// which is how SQLite reports a quota or the maximum size of a file.
const SQLITE_FULL: [&str; 6] = ["13", "778", "1034", "1546", "4874", "8458"];
/// Code of PostgreSQL for lack of space, `disk_full`.
const POSTGRES_FULL: &str = "53100";

/// Returns true if a database failed for lack of space.
pub(crate) fn is_full(error: &sqlx::Error) -> bool {
    match error {
        sqlx::Error::Database(error) => {
            let sqlite = error.try_downcast_ref::<sqlx::sqlite::SqliteError>().is_some();
            // The databases have different sets of codes; the type of the error decides which one
            // applies.
            let code = error.code();
            code.is_some_and(|code| {
                if sqlite { SQLITE_FULL.contains(&&*code) } else { code == POSTGRES_FULL }
            })
        }
        // A failed migration wraps the error of the database or of the system that caused it.
        sqlx::Error::Migrate(error) => {
            io_errors(&**error).any(is_out_of_space)
                || error_chain(&**error)
                    .any(|error| error.downcast_ref::<sqlx::Error>().is_some_and(is_full))
        }
        other => io_errors(other).any(is_out_of_space),
    }
}

/// Returns true if the system has no space for what was to be written: the disk is full, the quota
/// is used up, or the file has its maximum size.
pub fn is_out_of_space(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge
    )
}

/// Iterates over an error and its sources.
fn error_chain<'a>(
    error: &'a (dyn Error + 'static),
) -> impl Iterator<Item = &'a (dyn Error + 'static)> {
    std::iter::successors(Some(error), |error: &&'a (dyn Error + 'static)| (*error).source())
}

fn io_errors<'a>(error: &'a (dyn Error + 'static)) -> impl Iterator<Item = &'a io::Error> {
    error_chain(error).filter_map(|error| error.downcast_ref())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_told_from_other_failures() {
        for (kind, full) in [
            (ErrorKind::StorageFull, true),
            (ErrorKind::QuotaExceeded, true),
            (ErrorKind::NotFound, false),
        ] {
            let object = object_store::Error::Generic {
                store: "folder",
                source: Box::new(io::Error::from(kind)),
            };
            assert_eq!(
                StoreError::from(ObjectsError::from(object)).is_out_of_space(),
                full,
                "{kind}"
            );
            assert_eq!(
                StoreError::from(sqlx::Error::Io(kind.into())).is_out_of_space(),
                full,
                "{kind}"
            );
        }
        assert!(!StoreError::not_found("ship", "kcs").is_out_of_space());
    }

    #[test]
    fn damaged_data_are_told_from_a_store_that_does_not_answer() {
        let damaged = ObjectsError::Damaged { key: "a".to_owned(), actual: "b".to_owned() };
        let silent = object_store::Error::Generic { store: "S3", source: "no answer".into() };
        for (error, of_data, transient) in [
            (StoreError::not_found("object", "a"), true, false),
            (damaged.into(), true, false),
            (ObjectsError::from(silent).into(), false, true),
            (sqlx::Error::PoolTimedOut.into(), false, false),
        ] {
            assert_eq!(
                (error.is_data_fault(), error.is_transient()),
                (of_data, transient),
                "{error}"
            );
        }
    }
}
