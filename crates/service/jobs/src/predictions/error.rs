//! Errors of predictions.

use crate::budget::MemoryShortage;

/// Error of a prediction.
#[derive(Debug, thiserror::Error)]
pub enum PredictionError {
    /// A field of the request is not valid.
    #[error("{field}: {message}")]
    Field {
        /// Its place in the request.
        field: String,
        /// Message that says what is wrong with it.
        message: String,
    },
    /// There is not enough memory for the answer, now or ever.
    #[error(transparent)]
    Memory(#[from] MemoryShortage),
    /// The caller has no session with this id, or it has ended.
    #[error("you have no session `{0}`; a session ends after ten minutes without a request")]
    NoSession(String),
    /// The limit of sessions is reached.
    #[error("{whose} {most} sessions, which is the limit; end one, or wait until an idle one ends")]
    ManySessions {
        /// Owner of the sessions.
        whose: &'static str,
        /// Largest number of sessions.
        most: usize,
    },
    /// Another request uses the session.
    #[error("another request uses this session at the moment; wait for its answer")]
    SessionBusy,
    /// The answer cannot be written.
    #[error(transparent)]
    Answer(#[from] serde_json::Error),
}

impl PredictionError {
    /// Creates the error of a field of the request.
    pub(crate) fn invalid_field(field: &str, message: impl Into<String>) -> Self {
        Self::Field { field: field.to_owned(), message: message.into() }
    }
}

/// Result of a prediction.
pub type Result<T> = std::result::Result<T, PredictionError>;
