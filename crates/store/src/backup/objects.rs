//! Objects on their way into a backup and out of it.

use std::path::Path;

use futures::TryStreamExt as _;

use super::manifest::BackupManifest;
use super::not_a_backup;
use crate::error::{Result, StoreError};
use crate::object_list::ObjectName;
use crate::objects::{Objects, ObjectsError};

/// What has been copied.
#[derive(Debug, Default)]
pub(super) struct Copied {
    pub objects: usize,
    pub bytes: u64,
    pub lost: Vec<String>,
}

/// Copies objects, each verified by its hash; goes on where one is lost.
pub(super) async fn copy(from: &Objects, keys: &[String], to: &Objects) -> Result<Copied> {
    let mut copied = Copied::default();
    for key in keys {
        match from.get(key).await {
            Ok(bytes) => {
                copied.objects += 1;
                copied.bytes += bytes.len() as u64;
                to.put(bytes).await?;
            }
            Err(StoreError::NotFound { .. } | StoreError::Invalid { .. } | StoreError::Objects(ObjectsError::Damaged { .. })) => {
                copied.lost.push(key.clone());
            }
            Err(error) => return Err(error),
        }
    }
    Ok(copied)
}

pub(super) async fn must_be_empty(objects: &Objects) -> Result<()> {
    match objects.list().try_next().await? {
        Some(_) => Err(StoreError::conflict("object store", "objects", "is not empty; a backup is restored into an empty place")),
        None => Ok(()),
    }
}

/// Puts the objects of a backup where they belong. One that is missing or damaged is an error: a backup that was whole when
/// it was made must be so now.
pub(super) async fn put(folder: &Path, manifest: &BackupManifest, to: &Objects) -> Result<()> {
    let from = Objects::local(folder)?;
    let (mut count, mut all) = (0, from.list());
    while let Some(head) = all.try_next().await? {
        let ObjectName::Key(key) = head.name else { continue };
        to.put(from.get(&key).await?).await?;
        count += 1;
    }
    match count == manifest.objects {
        true => Ok(()),
        false => Err(not_a_backup(folder, format!("has {count} objects, not {} as when it was made", manifest.objects))),
    }
}
