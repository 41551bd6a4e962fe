//! Errors of derivations and other jobs.

use sistership_identification::refine::RefineError;
use sistership_learned::{JoinError, TrainError};
use sistership_model::FileError;
use sistership_store::StoreError;
use sistership_trials::samples::SamplesError;

/// Error of a derivation.
#[derive(Debug, thiserror::Error)]
pub enum DeriveError {
    /// An input that the recipe names is missing, or the store does not answer.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// An input that the recipe names is damaged or has changed.
    #[error("{0}")]
    Lost(String),
    /// A ship or law cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Samples cannot be read.
    #[error(transparent)]
    Samples(#[from] SamplesError),
    /// The refinement is refused, or was stopped.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// A learned correction cannot be trained.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// A learned correction and its weights do not belong together.
    #[error(transparent)]
    Join(#[from] JoinError),
    /// A state that should not occur, unless the program has a defect or others write at the same
    /// time.
    #[error("{0}")]
    Unexpected(String),
    /// A document cannot be written.
    #[error("a document cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The thread of the computation ended without a result.
    #[error("the computation was aborted by an internal error: {0}")]
    Broken(#[from] tokio::task::JoinError),
}
