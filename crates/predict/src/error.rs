//! Why a prediction cannot be made.

use sistership_pipeline::budget::Shortage;

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
