//! What a backup says of itself.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::content::{DatabaseCopy, DatabaseKind, FileHead, TableHead};
use super::files::{self, at, not_a_backup, write_whole};
use super::objects::CopiedObjects;
use crate::error::{Result, StoreError};
use crate::migrate;

/// The file whose presence makes a folder a backup.
const FILE: &str = "backup.json";
/// The format that this program writes and reads.
const FORMAT: &str = "sistership-backup/1";

/// What a backup says of itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BackupManifest {
    /// Always `sistership-backup/1`.
    pub format: String,
    /// What it was taken of, and can be restored to.
    pub database: DatabaseKind,
    /// The number of the last migration.
    pub schema: i64,
    /// When it was begun; what was acknowledged before is in it.
    pub created_us: i64,
    /// Its files, but for objects, which are named by their hashes.
    pub files: BTreeMap<String, FileHead>,
    /// Its tables, of PostgreSQL.
    pub tables: Vec<TableHead>,
    /// The number of its objects.
    pub objects: usize,
    /// Their size.
    pub object_bytes: u64,
    /// Objects that rows refer to but that were missing or damaged: their keys.
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
            let head = files::head(folder.join(&file)).await?;
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
            std::io::ErrorKind::NotFound => not_a_backup(
                folder,
                format!("is no backup, or an unfinished one: it has no {FILE}"),
            ),
            _ => at(&path)(error),
        })?;
        serde_json::from_slice(&text)
            .map_err(|error| not_a_backup(folder, format!("{FILE} does not read: {error}")))
    }

    /// Whether this program can restore it there, and whether its files are what they were.
    pub(crate) async fn check(&self, folder: &Path, url: &str) -> Result<()> {
        if self.format != FORMAT || self.schema > migrate::newest() {
            let message = format!(
                "was made by a newer program ({}, schema {}); restore it with that",
                self.format, self.schema
            );
            return Err(not_a_backup(folder, message));
        }
        if !self.database.is_of(url) {
            let kind = self.database.scheme();
            return Err(StoreError::invalid(
                "database_url",
                format!("the backup is of another kind of database; must begin with {kind}"),
            ));
        }
        for (file, expected) in &self.files {
            if files::head(folder.join(file)).await? != *expected {
                return Err(not_a_backup(folder, format!("its file {file} is damaged")));
            }
        }
        Ok(())
    }
}
