//! Why a bundle cannot be made, read or taken.

use sistership_store::StoreError;

use crate::error::DeriveError;

/// Why a bundle cannot be made, read or taken.
#[derive(Debug, thiserror::Error)]
pub enum BundleError {
    /// The archive does not answer, or something is not there.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A document does not read.
    #[error(transparent)]
    Document(#[from] DeriveError),
    /// A version was derived from what a bundle does not hold.
    #[error("version {0} was refined with the prior of a family, which a bundle does not hold")]
    Prior(String),
    /// The file is no bundle, or is not what it was.
    #[error("{0}")]
    File(String),
    /// A key is not one that signs bundles, or checks them.
    #[error("{0}")]
    Key(&'static str),
    /// What is in the archive contradicts the bundle; nothing was written.
    #[error("nothing was taken:\n{}", .0.join("\n"))]
    Conflicts(Vec<String>),
}
