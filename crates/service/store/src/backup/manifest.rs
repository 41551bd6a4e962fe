//! Manifest of a backup.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::content::{DatabaseCopy, DatabaseKind, FileHead, TableHead};
use super::files::{self, file_error, not_a_backup, write_whole};
use super::objects::CopiedObjects;
use crate::error::{Result, StoreError};
use crate::migrate;

/// The file whose presence makes a folder a backup.
const FILE: &str = "backup.json";
/// The format that this program writes and reads.
const FORMAT: &str = "sistership-backup/1";

/// Manifest of a backup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BackupManifest {
    /// Format of the backup, always `sistership-backup/1`.
    pub format: String,
    /// Kind of the database that was copied; it can be restored to this kind only.
    pub database: DatabaseKind,
    /// Number of the last migration of its schema.
    pub schema: i64,
    /// Time of the start, microseconds since 1970; everything acknowledged before is included.
    pub created_us: i64,
    /// Files other than objects, by path below the folder of the backup; objects are named by their
    /// hashes.
    pub files: BTreeMap<String, FileHead>,
    /// Tables, for PostgreSQL.
    pub tables: Vec<TableHead>,
    /// Number of objects.
    pub objects: usize,
    /// Total size of the objects, bytes.
    pub object_bytes: u64,
    /// Keys of objects that rows refer to and that were missing or damaged.
    pub lost: Vec<String>,
}

impl BackupManifest {
    pub(crate) async fn new(
        folder: &Path,
        created_us: i64,
        taken: DatabaseCopy,
        copied: CopiedObjects,
    ) -> Result<Self> {
        let mut files = BTreeMap::new();
        for file in taken.files {
            let head = files::file_head(folder.join(&file)).await?;
            files.insert(file, head);
        }
        Ok(Self {
            format: FORMAT.to_owned(),
            database: taken.kind,
            schema: taken.schema,
            created_us,
            files,
            tables: taken.tables,
            objects: copied.objects,
            object_bytes: copied.bytes,
            lost: copied.lost,
        })
    }

    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_vec_pretty(self)
            .map_err(|error| not_a_backup(folder, error.to_string()))?;
        write_whole(&folder.join(FILE), |path| std::fs::write(path, text))
    }

    /// Reads the manifest of a backup.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(FILE);
        let text = std::fs::read(&path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                not_a_backup(folder, format!("is not a complete backup: {FILE} is missing"))
            }
            // Only a missing manifest means that it is not a backup; other errors are reported as
            // such.
            _ => file_error(&path)(error),
        })?;
        serde_json::from_slice(&text)
            .map_err(|error| not_a_backup(folder, format!("{FILE} cannot be parsed: {error}")))
    }

    /// Checks that this program can restore the backup to `url`, and that its files are unchanged.
    pub(crate) async fn check_restorable(&self, folder: &Path, url: &str) -> Result<()> {
        // A newer schema may have columns that this program does not know.
        if self.format != FORMAT || self.schema > migrate::newest_version() {
            let message = format!(
                "was made by a newer version ({}, schema {}); restore it with that version",
                self.format, self.schema
            );
            return Err(not_a_backup(folder, message));
        }
        if !self.database.matches_url(url) {
            let kind = self.database.url_scheme();
            return Err(StoreError::invalid(
                "database_url",
                format!(
                    "the backup is of another kind of database; the URL must begin with {kind}"
                ),
            ));
        }
        // Every file is read once before anything is restored.
        for (file, expected) in &self.files {
            if files::file_head(folder.join(file)).await? != *expected {
                return Err(not_a_backup(folder, format!("its file {file} is damaged")));
            }
        }
        Ok(())
    }
}
