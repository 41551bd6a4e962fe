//! Why a prediction cannot be made.

use crate::budget::Shortage;

/// Why a prediction cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PredictError {
    /// A field of the request is not what it should be.
    #[error("{field}: {message}")]
    Field {
        /// Its place in the request.
        field: String,
        /// What is wrong with it.
        message: String,
    },
    /// There is no memory for its answer, now or ever.
    #[error(transparent)]
    Memory(#[from] Shortage),
    /// Somebody has no session of this id, or has none any longer.
    #[error("there is no session `{0}` of yours; one that is not asked for ten minutes ends")]
    NoSession(String),
    /// There are as many sessions as there may be.
    #[error(
        "{whose} {most} sessions, and may not have more; end one, or wait until an idle one ends"
    )]
    ManySessions {
        /// Whose they are.
        whose: &'static str,
        /// How many there are.
        most: usize,
    },
    /// Another request has the ship.
    #[error("another request sails this session at the moment; wait for its answer")]
    SessionBusy,
    /// The answer cannot be written.
    #[error(transparent)]
    Answer(#[from] serde_json::Error),
}

impl PredictError {
    /// Of a field of the request.
    pub(crate) fn invalid(field: &str, message: impl Into<String>) -> Self {
        Self::Field { field: field.to_owned(), message: message.into() }
    }
}

/// What a prediction gives.
pub type Result<T> = std::result::Result<T, PredictError>;
