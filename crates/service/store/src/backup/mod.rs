//! Backup of a store while others write, and restoration from it.
//!
//! The database is copied as it was at one moment; then the objects that its rows refer to, which
//! were durable before those rows were written. A folder is a backup once its manifest is there,
//! which is written last.

mod content;
mod files;
mod manifest;
mod objects;
mod postgres;
mod sqlite;

use std::path::Path;
use std::sync::Arc;

pub use content::{DatabaseKind, FileHead, TableHead};
pub use manifest::BackupManifest;
#[cfg(feature = "testing")]
pub(crate) use postgres::TABLES;

use crate::clock::SystemClock;
use crate::connections::DatabaseWriter;
use crate::error::Result;
use crate::objects::ObjectStorage;
use crate::store::Store;

impl Store {
    /// Copies this store, with the objects that it refers to, into `folder`, which must be empty or
    /// absent. Objects that are missing or damaged are skipped and listed in the manifest.
    pub async fn backup(&self, objects: &ObjectStorage, folder: &Path) -> Result<BackupManifest> {
        files::create_empty(folder)?;
        let created_us = self.now_us();
        let taken = match &self.database().write {
            DatabaseWriter::Sqlite(group) => sqlite::copy_database(group.pool(), folder).await?,
            DatabaseWriter::Postgres(pool) => {
                postgres::copy_database(&pool.current_lease().pool, folder).await?
            }
        };
        // Objects after rows: every object of the copied rows was durable before its row was
        // written.
        let copied =
            objects::copy_objects(objects, &taken.keys, &ObjectStorage::open_folder(folder)?)
                .await?;
        let manifest = BackupManifest::new(folder, created_us, taken, copied).await?;
        manifest.write(folder)?;
        Ok(manifest)
    }

    /// Restores a backup: `url` must name a database of the same kind without tables, and `objects`
    /// must be empty.
    pub async fn restore(
        folder: &Path,
        url: &str,
        objects: &ObjectStorage,
    ) -> Result<BackupManifest> {
        let manifest = BackupManifest::read(folder)?;
        manifest.check_restorable(folder, url).await?;
        objects::must_be_empty(objects).await?;
        match manifest.database {
            DatabaseKind::Sqlite => sqlite::must_be_absent(url)?,
            DatabaseKind::Postgres => postgres::must_be_empty(url).await?,
        }
        // Objects first: no row may refer to an object that is not there yet.
        objects::restore_objects(folder, manifest.objects, objects).await?;
        match manifest.database {
            DatabaseKind::Sqlite => sqlite::restore_database(folder, url).await?,
            DatabaseKind::Postgres => postgres::restore_database(folder, &manifest, url).await?,
        }
        // Brings the schema up to date where this program is newer than the backup.
        Self::connect(url, Arc::new(SystemClock)).await?.close().await;
        Ok(manifest)
    }
}
