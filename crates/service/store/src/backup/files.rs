//! Files and folders of a backup.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::content::FileHead;
use crate::error::{Result, StoreError};
use crate::folders;

/// A failure of the file system, with the file.
pub(crate) fn at(path: &Path) -> impl FnOnce(io::Error) -> StoreError {
    move |error| StoreError::File { path: path.to_path_buf(), error }
}

/// Makes the folder of a new backup.
pub(crate) fn claim(folder: &Path) -> Result<()> {
    folders::make(folder).map_err(at(folder))?;
    let first = fs::read_dir(folder).map_err(at(folder))?.next();
    match first {
        Some(_) => Err(not_a_backup(folder, "is not empty; a backup needs a folder of its own")),
        None => Ok(()),
    }
}

/// Size and hash of a file, read where it holds nobody up.
pub(crate) async fn head(path: PathBuf) -> Result<FileHead> {
    let reading = tokio::task::spawn_blocking(move || hash(&path).map_err(at(&path)));
    reading.await.map_err(crate::objects_error::ObjectsError::from)?
}

fn hash(path: &Path) -> io::Result<FileHead> {
    let (mut file, mut hasher, mut bytes) = (File::open(path)?, Sha256::new(), 0);
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
    let sha256 = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(FileHead { bytes, sha256 })
}

/// Writes a file so that it is there whole or not at all, also after the power has failed.
pub(crate) fn write_whole(path: &Path, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<()> {
    let partial = path.with_added_extension("partial");
    let done = write(&partial)
        .and_then(|()| File::open(&partial)?.sync_all())
        .and_then(|()| fs::rename(&partial, path));
    done.and_then(|()| folders::sync(path.parent().unwrap_or(Path::new("")))).map_err(at(path))
}

/// The refusal of a folder that is no backup, or a damaged one.
pub(crate) fn not_a_backup(folder: &Path, message: impl Into<String>) -> StoreError {
    StoreError::conflict("backup", folder.display().to_string(), message)
}
