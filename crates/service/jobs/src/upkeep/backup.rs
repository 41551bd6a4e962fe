//! A copy of an archive, and an archive made of it again.

use std::path::Path;

use sistership_store::{BackupManifest, Objects, ObjectsPlace, Result, Store};

use crate::archive::Archive;

/// Copies an archive into a folder while others write, see [`Store::backup`].
///
/// # Errors
/// The folder is not empty, or the database, the object store or the folder cannot be used.
pub async fn backup(archive: &Archive, folder: &Path) -> Result<BackupManifest> {
    archive.store.backup(&archive.objects, folder).await
}

/// Makes an archive of a backup, in an empty place, see [`Store::restore`].
///
/// # Errors
/// The place is not empty, the backup is damaged or of another kind of database, or something
/// cannot be written.
pub async fn restore(
    folder: &Path,
    database_url: &str,
    samples: &ObjectsPlace,
) -> Result<BackupManifest> {
    // Before the data folder is made: a backup that does not read leaves nothing behind.
    BackupManifest::read(folder)?;
    Store::restore(folder, database_url, &Objects::at(samples)?).await
}
