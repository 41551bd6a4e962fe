//! Temporary files of uploads, hashed as they arrive.

use std::io;

use bytes::Bytes;
use futures::{Stream, StreamExt as _};
use sha2::{Digest as _, Sha256};
use sistership_auth::to_hex;
use sistership_store::is_out_of_space;
use tempfile::{NamedTempFile, TempPath};
use tokio::fs::File;
use tokio::io::{AsyncWriteExt as _, BufWriter};

use crate::problem::{Problem, Result};

pub use crate::spool_folder::SpoolFolder;

/// A received file, which is removed when this is dropped.
#[derive(Debug)]
pub struct SpooledFile {
    /// Path.
    pub path: TempPath,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// Writes a stream to a temporary file.
pub async fn spool_stream<E: Into<Problem>>(
    place: &SpoolFolder,
    mut stream: impl Stream<Item = Result<Bytes, E>> + Unpin,
) -> Result<SpooledFile> {
    let (file, path) = temporary_file(place)?.into_parts();
    let (mut file, mut hash) = (BufWriter::new(File::from_std(file)), Sha256::new());
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(Into::into)?;
        hash.update(&chunk);
        file.write_all(&chunk).await.map_err(write_problem)?;
    }
    file.flush().await.map_err(write_problem)?;
    Ok(SpooledFile { path, sha256: to_hex(&hash.finalize()) })
}

/// Creates a temporary file, which is removed when it is dropped.
pub fn temporary_file(place: &SpoolFolder) -> Result<NamedTempFile> {
    place.temporary_file().map_err(write_problem)
}

/// Returns the problem of an upload that could not be written.
pub fn write_problem(error: io::Error) -> Problem {
    let reason = format!("an upload cannot be written: {error}");
    if is_out_of_space(&error) { Problem::no_room(reason) } else { Problem::internal(reason) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[tokio::test]
    async fn a_file_has_the_hash_of_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let place = SpoolFolder::with_root(folder.path().to_path_buf());
        let pieces =
            ["a", "bc"].map(|piece| Ok::<_, Problem>(Bytes::from_static(piece.as_bytes())));
        let file = spool_stream(&place, futures::stream::iter(pieces)).await.unwrap();
        assert_eq!(std::fs::read(&file.path).unwrap(), b"abc");
        // NIST FIPS 180-2, appendix B.1.
        assert!(file.sha256.starts_with("ba7816bf8f01cfea4141"), "{}", file.sha256);
    }

    #[test]
    fn a_full_disk_is_told() {
        for (kind, status) in [
            (io::ErrorKind::StorageFull, 507),
            (io::ErrorKind::QuotaExceeded, 507),
            (io::ErrorKind::Other, 500),
        ] {
            assert_eq!(write_problem(kind.into()).status, status);
        }
    }
}
