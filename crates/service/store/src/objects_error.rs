//! Error of the object store.

/// Error of the object store.
#[derive(Debug, thiserror::Error)]
pub enum ObjectsError {
    /// The bytes that were read are not those that were put.
    #[error("the object `{key}` is damaged: its content has the hash {actual}")]
    Damaged {
        /// The requested hash.
        key: String,
        /// The hash of the stored bytes.
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

impl ObjectsError {
    /// Returns true for a failure that may pass: the store fails, refuses, or does not answer.
    pub fn is_passing(&self) -> bool {
        use object_store::Error::{Generic, PermissionDenied, Unauthenticated};
        match self {
            Self::Store(Generic { .. } | PermissionDenied { .. } | Unauthenticated { .. }) => true,
            Self::Late(_) => true,
            Self::Store(_) | Self::Damaged { .. } | Self::Folder(_) | Self::Stopped(_) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_bucket_does_not_do_now_is_told_from_what_it_will_never_do() {
        let source = || Box::new(std::io::Error::other("503 Service Unavailable"));
        let path = || "a".to_owned();
        for (error, expected) in [
            (object_store::Error::Generic { store: "S3", source: source() }, true),
            (object_store::Error::PermissionDenied { path: path(), source: source() }, true),
            (object_store::Error::Unauthenticated { path: path(), source: source() }, true),
            (object_store::Error::NotFound { path: path(), source: source() }, false),
        ] {
            assert_eq!(ObjectsError::from(error).is_passing(), expected);
        }
    }
}
