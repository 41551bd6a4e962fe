//! Copies of objects into a backup and out of it.

use std::path::Path;

use futures::stream::{self, StreamExt as _, TryStreamExt as _};

use super::files::not_a_backup;
use crate::error::{Result, StoreError};
use crate::object_list::{MAX_CONCURRENT, ObjectName};
use crate::objects::ObjectStorage;
use crate::objects_error::ObjectsError;

/// Summary of the copied objects.
#[derive(Debug, Default)]
pub(crate) struct CopiedObjects {
    pub objects: usize,
    pub bytes: u64,
    pub lost: Vec<String>,
}

/// Outcome for one object.
enum ObjectCopy {
    Whole { bytes: u64 },
    Lost { key: String },
}

/// Copies objects, each verified by its hash; continues if one is missing or damaged.
pub(crate) async fn copy_objects(
    from: &ObjectStorage,
    keys: &[String],
    to: &ObjectStorage,
) -> Result<CopiedObjects> {
    let mut copied = CopiedObjects::default();
    let copies: Vec<_> = keys.iter().map(|key| copy_one(from, key.clone(), to)).collect();
    // Several copies at a time; `buffered` keeps their order.
    let mut copies = stream::iter(copies).buffered(MAX_CONCURRENT);
    while let Some(copy) = copies.try_next().await? {
        match copy {
            ObjectCopy::Whole { bytes } => {
                copied.objects += 1;
                copied.bytes += bytes;
            }
            ObjectCopy::Lost { key } => copied.lost.push(key),
        }
    }
    Ok(copied)
}

/// Copies an object if it is present and undamaged; other errors end the backup.
async fn copy_one(from: &ObjectStorage, key: String, to: &ObjectStorage) -> Result<ObjectCopy> {
    match from.get(&key).await {
        Ok(bytes) => {
            let size = bytes.len() as u64;
            to.put(bytes).await?;
            Ok(ObjectCopy::Whole { bytes: size })
        }
        // Missing, an invalid key, or damaged: recorded and skipped.
        Err(
            StoreError::NotFound { .. }
            | StoreError::Invalid { .. }
            | StoreError::Objects(ObjectsError::Damaged { .. }),
        ) => Ok(ObjectCopy::Lost { key }),
        Err(error) => Err(error),
    }
}

pub(crate) async fn must_be_empty(objects: &ObjectStorage) -> Result<()> {
    match objects.list().try_next().await? {
        Some(_) => Err(StoreError::conflict(
            "object store",
            "objects",
            "is not empty; restore the backup to an empty place",
        )),
        None => Ok(()),
    }
}

/// Restores the objects of a backup. A missing or damaged object is an error: all `expected`
/// objects were complete when the backup was made.
pub(crate) async fn restore_objects(
    folder: &Path,
    expected: usize,
    to: &ObjectStorage,
) -> Result<()> {
    let from = ObjectStorage::open_folder(folder)?;
    let (mut count, mut all) = (0, from.list());
    while let Some(head) = all.try_next().await? {
        // Other files in the folder are no objects of the backup.
        let ObjectName::Key(key) = head.name else { continue };
        to.put(from.get(&key).await?).await?;
        count += 1;
    }
    match count == expected {
        true => Ok(()),
        false => Err(not_a_backup(
            folder,
            format!("has {count} objects, but had {expected} when it was made"),
        )),
    }
}
