//! Storage of uploads, and their limits.

use std::sync::Arc;

use crate::spool::SpoolFolder;

/// Storage of uploads until they have been read, and their limits.
#[derive(Debug, Clone)]
pub struct UploadPlace {
    /// Spool of the files.
    pub spool: Arc<SpoolFolder>,
    /// Maximum number of files of one upload.
    pub files: usize,
    /// Maximum size of the manifest, bytes.
    pub yaml_bytes: usize,
}
