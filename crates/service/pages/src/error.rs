//! Why a page cannot be shown.

use sistership_jobs::error::DeriveError;
use sistership_model::FileError;
use sistership_store::StoreError;

/// Why a page cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The archive does not give what the page shows.
    #[error(transparent)]
    Derive(#[from] DeriveError),
    /// A field of the page's form is at fault.
    #[error("{field}: {message}")]
    Invalid {
        /// The field's name.
        field: String,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// The page cannot be written.
    #[error("the page cannot be written: {0}")]
    Render(#[from] askama::Error),
}

/// What a page or a part of it comes to.
pub type Result<T, E = PageError> = std::result::Result<T, E>;

impl PageError {
    /// A field that is at fault.
    pub fn invalid(field: &str, message: impl Into<String>) -> Self {
        Self::Invalid { field: field.to_owned(), message: message.into() }
    }
}

impl From<StoreError> for PageError {
    fn from(error: StoreError) -> Self {
        Self::Derive(error.into())
    }
}

impl From<FileError> for PageError {
    fn from(error: FileError) -> Self {
        Self::Derive(error.into())
    }
}

impl From<serde_json::Error> for PageError {
    fn from(error: serde_json::Error) -> Self {
        Self::Derive(error.into())
    }
}
