//! Errors of pages.

use sistership_jobs::error::DeriveError;
use sistership_model::FileError;
use sistership_store::StoreError;

/// Error of a page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The archive does not give the data of the page.
    #[error(transparent)]
    Derive(#[from] DeriveError),
    /// A field of the page's form is wrong.
    #[error("{field}: {message}")]
    Invalid {
        /// Name of the field.
        field: String,
        /// Description of the error and its correction.
        message: String,
    },
    /// The page cannot be rendered.
    #[error("the page cannot be written: {0}")]
    Render(#[from] askama::Error),
}

/// Result of a page or of a part of it.
pub type Result<T, E = PageError> = std::result::Result<T, E>;

impl PageError {
    /// Returns the error of a wrong field.
    pub fn invalid_field(field: &str, message: impl ToString) -> Self {
        Self::Invalid { field: field.to_owned(), message: message.to_string() }
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
