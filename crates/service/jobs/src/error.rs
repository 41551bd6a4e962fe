//! Why a version, or anything else that a job makes, cannot be made.

use sistership_identification::refine::RefineError;
use sistership_learned::{JoinError, TrainError};
use sistership_model::FileError;
use sistership_store::StoreError;
use sistership_trials::samples::SamplesError;

/// Why a version cannot be derived.
#[derive(Debug, thiserror::Error)]
pub enum DeriveError {
    /// Something that the recipe names is not there.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Something that the recipe names is no longer what it was.
    #[error("{0}")]
    Lost(String),
    /// A ship or law does not read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Samples do not read.
    #[error(transparent)]
    Samples(#[from] SamplesError),
    /// The refinement is refused, or was stopped.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// A branch cannot be trained.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// A branch and its weights do not belong together.
    #[error(transparent)]
    Join(#[from] JoinError),
    /// What does not happen unless the program is at fault, or others keep writing.
    #[error("{0}")]
    Unexpected(String),
    /// A document cannot be written.
    #[error("a document cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The thread that computed is gone.
    #[error("the computation broke off: {0}")]
    Broken(#[from] tokio::task::JoinError),
}
