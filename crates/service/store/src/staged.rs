//! Partial files that killed processes leave in a local object store: the object store writes to a
//! file named like the object with `#` and a number appended, and does not list it. A write to a
//! bucket is one request and leaves nothing.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::clock::duration_us;
use crate::error::Result;
use crate::objects::{FOLDER, ObjectStorage};
use crate::objects_error::ObjectsError;

/// Age after which a partial file counts as abandoned.
const ABANDONED_AFTER: Duration = Duration::from_secs(60);

/// A write of an object that has not ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StagedObject {
    /// Path of the file below the folder of the objects.
    pub path: String,
    /// Present size, bytes.
    pub bytes: u64,
    /// Time of the last write, microseconds since 1970.
    pub modified_us: i64,
}

impl ObjectStorage {
    /// Returns the partial files of writes that have not ended, or never will; none for a bucket.
    pub async fn list_staged(&self) -> Result<Vec<StagedObject>> {
        let Some(root) = self.folder.clone() else { return Ok(Vec::new()) };
        run_blocking(move || find_staged(&root)).await
    }

    /// Takes a shared lock that holds off [`clear_staged`](Self::clear_staged) during a write; none
    /// where the file system has no locks.
    pub(crate) async fn lock_shared(&self) -> Result<Option<fs::File>> {
        let Some(root) = self.folder.clone() else { return Ok(None) };
        run_blocking(move || {
            Ok(fs::File::open(root).ok().filter(|folder| folder.lock_shared().is_ok()))
        })
        .await
    }

    /// Removes the partial files of processes that have ended, and returns their number. An
    /// exclusive lock on the folder excludes writes meanwhile; recently written files stay, because
    /// some shared file systems keep locks on one host only.
    pub async fn clear_staged(&self) -> Result<usize> {
        let Some(root) = self.folder.clone() else { return Ok(0) };
        run_blocking(move || {
            let folder = fs::File::open(&root)?;
            // Another process writes at present, or the file system has no locks: nothing is
            // removed.
            if folder.try_lock().is_err() {
                return Ok(0);
            }
            let settled = |staged: &StagedObject| {
                let age = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, duration_us)
                    - staged.modified_us;
                age > duration_us(ABANDONED_AFTER)
            };
            let left: Vec<_> = find_staged(&root)?.into_iter().filter(settled).collect();
            left.iter()
                .try_for_each(|staged| ignore_missing(fs::remove_file(root.join(&staged.path))))?;
            Ok(left.len())
        })
        .await
    }

    /// Removes one partial file. The caller must be sure that its write is not in progress.
    pub async fn remove_staged(&self, staged: &StagedObject) -> Result<()> {
        let Some(root) = self.folder.clone() else { return Ok(()) };
        let path = root.join(&staged.path);
        run_blocking(move || ignore_missing(fs::remove_file(path))).await
    }
}

async fn run_blocking<T: Send + 'static>(
    work: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> Result<T> {
    let done = tokio::task::spawn_blocking(work).await.map_err(ObjectsError::from)?;
    Ok(done.map_err(ObjectsError::from)?)
}

fn find_staged(root: &Path) -> io::Result<Vec<StagedObject>> {
    let mut found = Vec::new();
    for folder in folder_entries(&root.join(FOLDER))?.into_iter().filter(|path| path.is_dir()) {
        for file in folder_entries(&folder)?.into_iter().filter(|path| is_staged(path)) {
            found.extend(read_staged(root, &file)?);
        }
    }
    Ok(found)
}

/// Returns the entries of a folder; none if it does not exist.
fn folder_entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        entries => entries?.map(|entry| Ok(entry?.path())).collect(),
    }
}

fn is_staged(path: &Path) -> bool {
    let suffix = path
        .file_name()
        .and_then(|name| name.to_str())
        .and_then(|name| name.rsplit_once('#'))
        .map(|(_, suffix)| suffix);
    suffix.is_some_and(|suffix| {
        !suffix.is_empty() && suffix.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// Returns a partial file, unless its write has ended meanwhile.
fn read_staged(root: &Path, file: &Path) -> io::Result<Option<StagedObject>> {
    let about = match fs::metadata(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        about => about?,
    };
    // Relative to the root, as the listing of objects names them.
    let path = file.strip_prefix(root).unwrap_or(file).to_string_lossy().into_owned();
    let modified_us = about.modified()?.duration_since(UNIX_EPOCH).map_or(0, duration_us);
    Ok(Some(StagedObject { path, bytes: about.len(), modified_us }))
}

/// Ignores that a file to be removed is already absent.
fn ignore_missing(removed: io::Result<()>) -> io::Result<()> {
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Leftovers of a killed write are removed, unless they may still be written.
    #[tokio::test]
    async fn what_a_kill_has_left_is_removed() {
        let root = tempfile::tempdir().unwrap();
        let objects = ObjectStorage::open_folder(root.path()).unwrap();
        let key = objects.put("samples".into()).await.unwrap();
        let (left, fresh) =
            (root.path().join(FOLDER).join("ab#1"), root.path().join(FOLDER).join("ab#2"));
        let folder = root.path().join(FOLDER).join(&key[..2]);
        let [left, fresh] = [left, fresh].map(|path| folder.join(path.file_name().unwrap()));
        let old = SystemTime::now() - 2 * ABANDONED_AFTER;
        fs::File::create(&left).unwrap().set_modified(old).unwrap();
        fs::File::create(&fresh).unwrap();
        let putting = objects.lock_shared().await.unwrap();
        assert_eq!(objects.clear_staged().await.unwrap(), 0);
        drop(putting);
        assert_eq!(objects.clear_staged().await.unwrap(), 1);
        assert!(!left.exists() && fresh.exists() && objects.exists(&key).await.unwrap());
    }

    #[test]
    fn only_a_number_behind_the_sign_is_a_put_under_way() {
        for (name, staged) in [
            ("ab#1", true),
            ("ab#12", true),
            ("ab", false),
            ("ab#", false),
            ("ab#x", false),
            ("#x#3", true),
        ] {
            assert_eq!(is_staged(Path::new(name)), staged, "{name}");
        }
    }
}
