//! Backup and restoration of an archive.

use std::path::Path;

use sistership_store::{BackupManifest, ObjectStorage, ObjectsPlace, Result, Store};

use crate::archive::Archive;

/// Copies an archive into a folder while other processes write.
///
/// # Errors
/// Returns an error if the folder is not empty, or if the database, the object store or the folder
/// cannot be used.
pub async fn back_up_archive(archive: &Archive, folder: &Path) -> Result<BackupManifest> {
    archive.store.backup(&archive.objects, folder).await
}

/// Restores an archive from a backup, in an empty place.
///
/// # Errors
/// Returns an error if the place is not empty, if the backup is damaged or of another kind of
/// database, or if something cannot be written.
pub async fn restore_archive(
    folder: &Path,
    database_url: &str,
    samples: &ObjectsPlace,
) -> Result<BackupManifest> {
    // Before the data folder is created: a backup that cannot be read leaves nothing behind.
    BackupManifest::read(folder)?;
    Store::restore(folder, database_url, &ObjectStorage::open_at(samples)?).await
}
