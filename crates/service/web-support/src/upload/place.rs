//! Storage of uploads, and their limits.

use std::sync::Arc;

use crate::spool::Spool;

/// Storage of uploads until they have been read, and their limits.
#[derive(Debug, Clone)]
pub struct UploadPlace {
    /// Spool of the files.
    pub spool: Arc<Spool>,
    /// Maximum number of files of one upload.
    pub files: usize,
    /// Maximum size of the manifest, bytes.
    pub yaml_bytes: usize,
}
