//! Folders of temporary files, one for each process; the folder of a killed process is removed by
//! the next process.

use std::fs::{self, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::{Builder, NamedTempFile, TempDir};
use uuid::Uuid;

use sistership_store::is_out_of_space;

const PREFIX: &str = "upload-";
const FOLDER: &str = "process-";

/// Temporary files of this process: a folder with a lock, which the system releases when the
/// process ends.
#[derive(Debug)]
pub struct SpoolFolder {
    root: PathBuf,
    held: Mutex<Option<LockedFolder>>,
}

#[derive(Debug)]
struct LockedFolder {
    folder: PathBuf,
    /// Lock on the folder; closing the file releases it.
    _lock: Option<fs::File>,
}

impl SpoolFolder {
    /// Creates the spool of this process below a folder that processes share; nothing is created on
    /// the disk before the first file.
    pub fn with_root(root: PathBuf) -> Self {
        Self { root, held: Mutex::default() }
    }

    /// Returns the folder of this process, created if absent.
    fn process_folder(&self) -> io::Result<PathBuf> {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        // The folder may have been removed by another program; then a new one is made.
        if let Some(held) = held.as_ref().filter(|held| held.folder.is_dir()) {
            return Ok(held.folder.clone());
        }
        Ok(held.insert(LockedFolder::create_locked(&self.root)?).folder.clone())
    }

    /// Removes the leftovers of processes that have ended.
    ///
    /// # Errors
    /// Returns an error if a folder cannot be read or removed.
    pub fn clear_ended(&self) -> io::Result<()> {
        let entries = match fs::read_dir(&self.root) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries?,
        };
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name.starts_with(FOLDER) {
                clear_folder(&path)?;
            }
        }
        Ok(())
    }

    /// Creates a temporary file, which is removed when it is dropped.
    ///
    /// # Errors
    /// Returns an error if it cannot be created.
    pub fn temporary_file(&self) -> io::Result<NamedTempFile> {
        Builder::new().prefix(PREFIX).tempfile_in(self.process_folder()?)
    }

    /// Creates a temporary folder, which is removed with its files when it is dropped.
    ///
    /// # Errors
    /// Returns an error if it cannot be created.
    pub fn temporary_folder(&self) -> io::Result<TempDir> {
        Builder::new().prefix(PREFIX).tempdir_in(self.process_folder()?)
    }

    /// Returns true if there is space for a file of this many bytes.
    ///
    /// # Errors
    /// Returns an error if writing fails for another reason than a full disk.
    pub fn has_room(&self, bytes: usize) -> io::Result<bool> {
        let written = self
            .temporary_file()
            .and_then(|mut file| io::Write::write_all(&mut file, &vec![0; bytes]));
        match written {
            Err(error) if is_out_of_space(&error) => Ok(false),
            other => other.map(|()| true),
        }
    }
}

impl Drop for SpoolFolder {
    fn drop(&mut self) {
        if let Some(held) = self.held.get_mut().unwrap_or_else(PoisonError::into_inner) {
            // A folder with a file that is still in use stays; the next process removes it.
            let _ = fs::remove_dir(&held.folder);
        }
    }
}

impl LockedFolder {
    fn create_locked(root: &Path) -> io::Result<Self> {
        loop {
            let folder = root.join(format!("{FOLDER}{}", Uuid::now_v7()));
            fs::create_dir_all(&folder)?;
            let lock = lock_folder(&folder);
            // Another process may have cleared the folder before it was locked: try again.
            if folder.is_dir() {
                return Ok(Self { folder, _lock: lock });
            }
        }
    }
}

/// Locks a folder; none if the file system has no locks, and then no process can lock it to clear
/// it either.
fn lock_folder(folder: &Path) -> Option<fs::File> {
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
        Ok(()) => ignore_missing(fs::remove_dir_all(folder)),
        Err(TryLockError::WouldBlock) => Ok(()),
        // A file system without locks: what is there stays.
        Err(TryLockError::Error(_)) => Ok(()),
    }
}

/// Ignores that a file to be removed is already absent.
fn ignore_missing(removed: io::Result<()>) -> io::Result<()> {
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
        let (alive, next) = (
            SpoolFolder::with_root(root.path().to_owned()),
            SpoolFolder::with_root(root.path().to_owned()),
        );
        let kept = alive.temporary_file().unwrap();
        let dead = root.path().join(format!("{FOLDER}dead"));
        fs::create_dir(&dead).unwrap();
        fs::write(dead.join("upload-cut"), b"t_s").unwrap();
        next.clear_ended().unwrap();
        assert!(kept.path().exists() && !dead.exists());
        drop(kept);
        drop(alive);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0);
    }
}
