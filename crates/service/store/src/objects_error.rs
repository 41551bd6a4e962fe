//! Why the object store did not do it.

/// Why the object store did not do it.
#[derive(Debug, thiserror::Error)]
pub enum ObjectsError {
    /// The bytes that were read are not those that were put.
    #[error("the object `{key}` is damaged: its content has the hash {actual}")]
    Damaged {
        /// The hash that was asked for.
        key: String,
        /// The hash of what is there.
        actual: String,
    },
    /// The store behind it failed.
    #[error(transparent)]
    Store(#[from] object_store::Error),
    /// The folder could not be made.
    #[error("{0}")]
    Folder(#[from] std::io::Error),
    /// The store did not answer in time.
    #[error("no answer in time")]
    Late(#[from] tokio::time::error::Elapsed),
    /// The hash could not be computed: the task was stopped.
    #[error(transparent)]
    Stopped(#[from] tokio::task::JoinError),
}
