//! Files under way: a folder for each process, which the next one removes where a process was
//! killed.

use std::fs::{self, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use tempfile::{Builder, NamedTempFile, TempDir};
use uuid::Uuid;

use sistership_store::is_out_of_space;

/// Files that earlier programs left beside the folders, and that are older than this, belong to a
/// process that was killed.
const STALE: Duration = Duration::from_secs(3600);
const PREFIX: &str = "upload-";
const FOLDER: &str = "process-";

/// The files of this process: a folder that it holds a lock on, which the system takes back when
/// the process ends.
#[derive(Debug)]
pub struct Spool {
    root: PathBuf,
    held: Mutex<Option<Held>>,
}

#[derive(Debug)]
struct Held {
    folder: PathBuf,
    /// Closing it gives the lock back.
    _lock: Option<fs::File>,
}

impl Spool {
    /// The files of this process below a folder that processes share; nothing is made before the
    /// first of them.
    pub fn below(root: PathBuf) -> Self {
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
    ///
    /// # Errors
    /// A folder cannot be read or removed.
    pub fn clear(&self) -> io::Result<()> {
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

    /// A file under way; it goes when this is dropped.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn temporary(&self) -> io::Result<NamedTempFile> {
        Builder::new().prefix(PREFIX).tempfile_in(self.folder()?)
    }

    /// A folder for files under way; it goes with them when this is dropped.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn folder_under_way(&self) -> io::Result<TempDir> {
        Builder::new().prefix(PREFIX).tempdir_in(self.folder()?)
    }

    /// Whether there is room for a file of this many bytes.
    ///
    /// # Errors
    /// Writing fails for another reason than a full disk.
    pub fn has_room(&self, bytes: usize) -> io::Result<bool> {
        let written =
            self.temporary().and_then(|mut file| io::Write::write_all(&mut file, &vec![0; bytes]));
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
        // A file system without locks: what is there stays.
        Err(TryLockError::Error(_)) => Ok(()),
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A process that was killed holds no lock any more; one that lives keeps its files, however
    /// old they are.
    #[test]
    fn what_no_living_process_holds_is_removed() {
        let root = tempfile::tempdir().unwrap();
        let (alive, next) =
            (Spool::below(root.path().to_owned()), Spool::below(root.path().to_owned()));
        let kept = alive.temporary().unwrap();
        let dead = root.path().join(format!("{FOLDER}dead"));
        fs::create_dir(&dead).unwrap();
        fs::write(dead.join("upload-cut"), b"t_s").unwrap();
        next.clear().unwrap();
        assert!(kept.path().exists() && !dead.exists());
        drop(kept);
        drop(alive);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0);
    }
}
