//! Files under way: on disk, counted and hashed as they arrive.

use std::io;
use std::path::Path;
use std::time::{Duration, SystemTime};

use bytes::Bytes;
use futures::{Stream, StreamExt as _};
use sha2::{Digest as _, Sha256};
use tempfile::{Builder, NamedTempFile, TempPath};
use tokio::fs::File;
use tokio::io::{AsyncWriteExt as _, BufWriter};

use crate::problem::{Problem, Result};

/// Files of uploads that are older than this belong to a process that was killed.
const STALE: Duration = Duration::from_secs(3600);
const PREFIX: &str = "upload-";

/// A file that has arrived; it goes when this is dropped.
#[derive(Debug)]
pub(crate) struct Spooled {
    /// Where it lies.
    pub path: TempPath,
    /// The hash of its bytes.
    pub sha256: String,
}

/// Writes a stream to a file in `folder`.
pub(crate) async fn spool<E: Into<Problem>>(
    folder: &Path,
    mut stream: impl Stream<Item = Result<Bytes, E>> + Unpin,
) -> Result<Spooled> {
    let (file, path) = temporary(folder)?.into_parts();
    let (mut file, mut hash) = (BufWriter::new(File::from_std(file)), Sha256::new());
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(Into::into)?;
        hash.update(&chunk);
        file.write_all(&chunk).await.map_err(full)?;
    }
    file.flush().await.map_err(full)?;
    Ok(Spooled { path, sha256: hex(&hash.finalize()) })
}

/// A hash in lower-case hexadecimal.
pub(crate) fn hex(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A file among the uploads under way; it goes when this is dropped.
pub(crate) fn temporary(folder: &Path) -> Result<NamedTempFile> {
    Builder::new().prefix(PREFIX).tempfile_in(folder).map_err(full)
}

fn full(error: io::Error) -> Problem {
    Problem::internal(format!("an upload cannot be written: {error}"))
}

/// Removes what killed processes have left behind.
pub(crate) fn clear(folder: &Path) -> io::Result<()> {
    let before = SystemTime::now() - STALE;
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let ours = entry.file_name().to_string_lossy().starts_with(PREFIX);
        if ours && entry.metadata()?.modified()? < before {
            std::fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}
