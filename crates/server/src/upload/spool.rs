//! Files under way: on disk, counted and hashed as they arrive.

use std::fs::{self, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use bytes::Bytes;
use futures::{Stream, StreamExt as _};
use sha2::{Digest as _, Sha256};
use sistership_store::is_out_of_space;
use tempfile::{Builder, NamedTempFile, TempPath};
use tokio::fs::File;
use tokio::io::{AsyncWriteExt as _, BufWriter};
use uuid::Uuid;

use crate::problem::{Problem, Result};

/// Files that earlier programs left beside the folders, and that are older than this, belong to a
/// process that was killed.
const STALE: Duration = Duration::from_secs(3600);
const PREFIX: &str = "upload-";
const FOLDER: &str = "process-";

/// The files of this process: a folder that it holds a lock on, which the system takes back when
/// the process ends.
#[derive(Debug)]
pub(crate) struct Spool {
    root: PathBuf,
    held: Mutex<Option<Held>>,
}

#[derive(Debug)]
struct Held {
    folder: PathBuf,
    /// Closing it gives the lock back.
    _lock: Option<fs::File>,
}

/// A file that has arrived; it goes when this is dropped.
#[derive(Debug)]
pub(crate) struct Spooled {
    /// Where it lies.
    pub path: TempPath,
    /// The hash of its bytes.
    pub sha256: String,
}

impl Spool {
    /// The files of this process below a folder that processes share; nothing is made before the
    /// first of them.
    pub(crate) fn below(root: PathBuf) -> Self {
        Self { root, held: Mutex::default() }
    }

    /// The folder of this process, made if it is not there.
    fn folder(&self) -> io::Result<PathBuf> {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(held) = held.as_ref().filter(|held| held.folder.is_dir()) {
            return Ok(held.folder.clone());
        }
        Ok(held.insert(Held::make(&self.root)?).folder.clone())
    }

    /// Removes what processes have left behind that have ended.
    pub(crate) fn clear(&self) -> io::Result<()> {
        let entries = match fs::read_dir(&self.root) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries?,
        };
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name.starts_with(FOLDER) {
                clear_folder(&path)?;
            } else if name.starts_with(PREFIX) {
                clear_stale(&path)?;
            }
        }
        Ok(())
    }

    /// Whether there is room for a file of this many bytes.
    pub(crate) fn has_room(&self, bytes: usize) -> io::Result<bool> {
        let written = self.folder().and_then(|folder| {
            let mut file = Builder::new().prefix(PREFIX).tempfile_in(folder)?;
            io::Write::write_all(&mut file, &vec![0; bytes])
        });
        match written {
            Err(error) if is_out_of_space(&error) => Ok(false),
            other => other.map(|()| true),
        }
    }
}

impl Drop for Spool {
    fn drop(&mut self) {
        if let Some(held) = self.held.get_mut().unwrap_or_else(PoisonError::into_inner) {
            // Where a file is still being read, the next process removes it.
            let _ = fs::remove_dir(&held.folder);
        }
    }
}

impl Held {
    fn make(root: &Path) -> io::Result<Self> {
        loop {
            let folder = root.join(format!("{FOLDER}{}", Uuid::now_v7()));
            fs::create_dir_all(&folder)?;
            let lock = locked(&folder);
            // Another process that clears may have been faster than the lock.
            if folder.is_dir() {
                return Ok(Self { folder, _lock: lock });
            }
        }
    }
}

/// The lock on a folder; none where the file system knows no locks, and then no process gets one to
/// clear it by either.
fn locked(folder: &Path) -> Option<fs::File> {
    let file = fs::File::open(folder).ok()?;
    file.lock().ok().map(|()| file)
}

/// Removes the folder of a process that has ended.
fn clear_folder(folder: &Path) -> io::Result<()> {
    let file = match fs::File::open(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        file => file?,
    };
    match file.try_lock() {
        Ok(()) => gone(fs::remove_dir_all(folder)),
        Err(TryLockError::WouldBlock) => Ok(()),
        Err(TryLockError::Error(error)) => {
            tracing::debug!(%error, "locks are not known to the file system of uploads");
            Ok(())
        }
    }
}

fn clear_stale(file: &Path) -> io::Result<()> {
    let modified = match fs::metadata(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        about => about?.modified()?,
    };
    if modified < SystemTime::now() - STALE { gone(fs::remove_file(file)) } else { Ok(()) }
}

/// What is gone already is gone.
fn gone(removed: io::Result<()>) -> io::Result<()> {
    removed
        .or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Writes a stream to a file.
pub(crate) async fn spool<E: Into<Problem>>(
    place: &Spool,
    mut stream: impl Stream<Item = Result<Bytes, E>> + Unpin,
) -> Result<Spooled> {
    let (file, path) = temporary(place)?.into_parts();
    let (mut file, mut hash) = (BufWriter::new(File::from_std(file)), Sha256::new());
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(Into::into)?;
        hash.update(&chunk);
        file.write_all(&chunk).await.map_err(unwritten)?;
    }
    file.flush().await.map_err(unwritten)?;
    Ok(Spooled { path, sha256: hex(&hash.finalize()) })
}

/// A hash in lower-case hexadecimal.
pub(crate) fn hex(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A file among the uploads under way; it goes when this is dropped.
pub(crate) fn temporary(place: &Spool) -> Result<NamedTempFile> {
    let made = place.folder().and_then(|folder| Builder::new().prefix(PREFIX).tempfile_in(folder));
    made.map_err(unwritten)
}

fn unwritten(error: io::Error) -> Problem {
    let reason = format!("an upload cannot be written: {error}");
    if is_out_of_space(&error) { Problem::no_room(reason) } else { Problem::internal(reason) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A process that was killed holds no lock any more; one that lives keeps its files, however
    /// old they are.
    #[tokio::test]
    async fn what_no_living_process_holds_is_removed() {
        let root = tempfile::tempdir().unwrap();
        let (alive, next) =
            (Spool::below(root.path().to_owned()), Spool::below(root.path().to_owned()));
        let body = futures::stream::iter([Ok::<_, Problem>(Bytes::from_static(b"t_s,u_m_s"))]);
        let kept = spool(&alive, body).await.unwrap();
        let dead = root.path().join(format!("{FOLDER}dead"));
        fs::create_dir(&dead).unwrap();
        fs::write(dead.join("upload-cut"), b"t_s").unwrap();
        next.clear().unwrap();
        assert!(kept.path.exists() && !dead.exists());
        drop(kept);
        drop(alive);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_full_disk_is_told() {
        for (kind, status) in [
            (io::ErrorKind::StorageFull, 507),
            (io::ErrorKind::QuotaExceeded, 507),
            (io::ErrorKind::Other, 500),
        ] {
            assert_eq!(unwritten(kind.into()).status, status);
        }
    }
}
