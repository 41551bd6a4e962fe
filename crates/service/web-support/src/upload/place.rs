//! Where uploads lie, and how much of them is taken.

use std::sync::Arc;

use crate::spool::Spool;

/// Where uploads lie until they have been read, and how large they may be.
#[derive(Debug, Clone)]
pub struct UploadPlace {
    /// Where the files lie.
    pub spool: Arc<Spool>,
    /// Files of one upload.
    pub files: usize,
    /// The manifest, bytes.
    pub yaml_bytes: usize,
}
