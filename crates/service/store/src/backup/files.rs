//! Files and folders of a backup.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::content::FileHead;
use crate::error::{Result, StoreError};
use crate::folders;
use crate::objects::to_hex;

/// Returns a conversion of I/O errors that adds the path.
pub(crate) fn file_error(path: &Path) -> impl FnOnce(io::Error) -> StoreError {
    move |error| StoreError::File { path: path.to_path_buf(), error }
}

/// Creates the folder of a new backup, which must be empty or absent.
pub(crate) fn create_empty(folder: &Path) -> Result<()> {
    folders::create_durably(folder).map_err(file_error(folder))?;
    let first = fs::read_dir(folder).map_err(file_error(folder))?.next();
    match first {
        Some(_) => Err(not_a_backup(folder, "is not empty; choose an empty folder for the backup")),
        None => Ok(()),
    }
}

/// Returns size and hash of a file, read on a thread for blocking work.
pub(crate) async fn file_head(path: PathBuf) -> Result<FileHead> {
    let reading = tokio::task::spawn_blocking(move || hash_file(&path).map_err(file_error(&path)));
    reading.await.map_err(crate::objects_error::ObjectsError::from)?
}

fn hash_file(path: &Path) -> io::Result<FileHead> {
    let (mut file, mut hasher, mut bytes) = (File::open(path)?, Sha256::new(), 0);
    // Read in pieces of 1 MiB: a database may be larger than the memory.
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => break,
            read => {
                hasher.update(&buffer[..read]);
                bytes += read as u64;
            }
        }
    }
    Ok(FileHead { bytes, sha256: to_hex(&hasher.finalize()) })
}

/// Writes a file atomically and durably: after a power failure it is complete or absent.
pub(crate) fn write_whole(path: &Path, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<()> {
    let partial = path.with_added_extension("partial");
    // Order matters: first the content is synced, then renamed, then the entry of the folder is
    // synced.
    let done = write(&partial)
        .and_then(|()| File::open(&partial)?.sync_all())
        .and_then(|()| fs::rename(&partial, path));
    done.and_then(|()| folders::sync_folder(path.parent().unwrap_or(Path::new(""))))
        .map_err(file_error(path))
}

/// Returns the error of a folder that is not a backup, or is a damaged one.
pub(crate) fn not_a_backup(folder: &Path, message: impl Into<String>) -> StoreError {
    StoreError::conflict("backup", folder.display().to_string(), message)
}
