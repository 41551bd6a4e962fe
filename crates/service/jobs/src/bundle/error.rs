//! Errors of bundles.

use sistership_store::StoreError;

use crate::error::DeriveError;

/// Error of a bundle that cannot be written, read or imported.
#[derive(Debug, thiserror::Error)]
pub enum BundleError {
    /// The archive does not answer, or a row is missing.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A document cannot be read.
    #[error(transparent)]
    Document(#[from] DeriveError),
    /// A version was derived from a prior, which a bundle does not hold.
    #[error("version {0} was refined with the prior of a family, which a bundle cannot contain")]
    Prior(String),
    /// The file is no bundle, or was changed.
    #[error("{0}")]
    File(String),
    /// A key that cannot sign or verify bundles.
    #[error("{0}")]
    Key(&'static str),
    /// Rows of the archive contradict the bundle; nothing was written.
    #[error("nothing was imported:\n{}", .0.join("\n"))]
    Conflicts(Vec<String>),
}
