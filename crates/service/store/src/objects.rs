//! Objects: bytes named by their SHA-256, in a local folder or in a bucket of an S3-compatible
//! store, see [`crate::ObjectsPlace`].
//!
//! An object that [`Objects::put`] has acknowledged is durable, so that a row may refer to it: on
//! the disk, including the entries of its folders, or as the server of the bucket confirms.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bytes::Bytes;
use futures::stream::BoxStream;
use futures::{StreamExt as _, TryStreamExt as _};
use object_store::local::LocalFileSystem;
use object_store::memory::InMemory;
use object_store::path::Path as ObjectPath;
use object_store::{ObjectStore, ObjectStoreExt as _, PutPayload};
use sha2::{Digest as _, Sha256};

use crate::checks;
use crate::error::{Result, StoreError};
use crate::folders;
use crate::objects_error::ObjectsError;

/// A content-addressed object store. A clone is another handle on the same store.
#[derive(Debug, Clone)]
pub struct ObjectStorage {
    pub(crate) store: Arc<dyn ObjectStore>,
    /// Root folder of a local store; none for a bucket.
    pub(crate) folder: Option<PathBuf>,
}

impl ObjectStorage {
    /// Opens a store below the folder `root`, which is created if absent.
    pub fn open_folder(root: &Path) -> Result<Self> {
        folders::create_durably(root).map_err(ObjectsError::from)?;
        let store = LocalFileSystem::new_with_prefix(root).map_err(ObjectsError::from)?;
        Ok(Self { store: Arc::new(store.with_fsync(true)), folder: Some(root.to_path_buf()) })
    }

    /// Creates a store in memory.
    pub fn in_memory() -> Self {
        Self::from_store(Arc::new(InMemory::new()))
    }

    /// Wraps any store.
    pub fn from_store(store: Arc<dyn ObjectStore>) -> Self {
        Self { store, folder: None }
    }

    /// Writes the marker that [`health`](Self::health) looks for, unless it exists: a folder that
    /// is no longer mounted does not have it.
    pub async fn write_marker(&self) -> Result<()> {
        let (mark, about) = (ObjectPath::from(MARKER), PutPayload::from_static(ABOUT));
        let written = async {
            match self.store.head(&mark).await {
                Ok(_) => Ok(()),
                Err(_) => self.store.put(&mark, about).await.map(drop),
            }
        };
        let written = tokio::time::timeout(MARKER_WRITE_TIMEOUT, written).await;
        Ok(written.map_err(ObjectsError::from)?.map_err(ObjectsError::from)?)
    }

    /// Checks that the store answers in time and is the one that was [marked](Self::mark).
    pub async fn check_health(&self) -> Result<()> {
        let mark = ObjectPath::from(MARKER);
        let looked = tokio::time::timeout(MARKER_TIMEOUT, self.store.head(&mark)).await;
        looked.map_err(ObjectsError::from)?.map(drop).map_err(|error| object_error(MARKER, error))
    }

    /// Stores bytes and returns their key once they are durable. They are written even if the key
    /// exists: another writer may not have made them durable yet, and a damaged object is replaced.
    pub async fn put(&self, bytes: Bytes) -> Result<String> {
        let key = hash_bytes(bytes.clone()).await?;
        // Held until the write ends, so that no process takes its partial file for a leftover.
        let _held = self.lock_shared().await?;
        let (at, size) = (object_path(&key)?, bytes.len());
        let put = self.store.put(&at, PutPayload::from(bytes));
        tokio::time::timeout(transfer_timeout(size), put)
            .await
            .map_err(ObjectsError::from)?
            .map_err(ObjectsError::from)?;
        Ok(key)
    }

    /// Returns the bytes of a key, verified by their hash.
    pub async fn get(&self, key: &str) -> Result<Bytes> {
        let at = object_path(key)?;
        // Two deadlines: for the head of the answer, then for the bytes by their number.
        let found = answer_in_time(self.store.get(&at)).await?;
        let found = found.map_err(|error| object_error(key, error))?;
        let size = usize::try_from(found.meta.size).unwrap_or(usize::MAX);
        let bytes = tokio::time::timeout(transfer_timeout(size), found.bytes()).await;
        let bytes = bytes.map_err(ObjectsError::from)?.map_err(|error| object_error(key, error))?;
        let actual = hash_bytes(bytes.clone()).await?;
        match actual == key {
            true => Ok(bytes),
            false => Err(ObjectsError::Damaged { key: key.to_owned(), actual }.into()),
        }
    }

    /// Returns the size and a stream of the bytes of a key, not yet verified: a caller that reads
    /// them to the end compares their hash.
    ///
    /// # Errors
    /// Returns an error if there is no such object, or the store fails.
    pub async fn get_stream(&self, key: &str) -> Result<(u64, BoxStream<'static, Result<Bytes>>)> {
        let found = answer_in_time(self.store.get(&object_path(key)?)).await?;
        let found = found.map_err(|error| object_error(key, error))?;
        let (size, key) = (found.meta.size, key.to_owned());
        Ok((size, found.into_stream().map_err(move |error| object_error(&key, error)).boxed()))
    }

    /// Removes the object of a key, if it exists. The caller must be sure that no row refers to it,
    /// see [`crate::Store::remove_unreferred`].
    pub(crate) async fn remove_object(&self, key: String) -> Result<()> {
        match answer_in_time(self.store.delete(&object_path(&key)?)).await? {
            // Idempotent: another process may have removed it.
            Ok(()) | Err(object_store::Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(ObjectsError::from(error).into()),
        }
    }

    /// Returns the size of the object of a key, bytes.
    pub async fn object_size(&self, key: &str) -> Result<u64> {
        let head = answer_in_time(self.store.head(&object_path(key)?)).await?;
        Ok(head.map_err(|error| object_error(key, error))?.size)
    }

    /// Returns true if there is an object of this key.
    pub async fn exists(&self, key: &str) -> Result<bool> {
        match answer_in_time(self.store.head(&object_path(key)?)).await? {
            Ok(_) => Ok(true),
            Err(object_store::Error::NotFound { .. }) => Ok(false),
            Err(error) => Err(ObjectsError::from(error).into()),
        }
    }
}

/// Returns the SHA-256 of bytes in lower-case hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    to_hex(&Sha256::digest(bytes))
}

/// Returns a hash in lower-case hexadecimal.
pub(crate) fn to_hex(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the hash, computed on a thread for blocking work.
async fn hash_bytes(bytes: Bytes) -> Result<String, ObjectsError> {
    Ok(tokio::task::spawn_blocking(move || sha256_hex(&bytes)).await?)
}

/// Maximum time for the check of the marker: a readiness probe waits for it.
const MARKER_TIMEOUT: Duration = Duration::from_millis(800);
/// Maximum time for writing the marker: the start of a process waits for it.
const MARKER_WRITE_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum time for the answer of the store, including retries.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(20);
/// Minimum rate of transfer of an object, bytes per second, below any link in use.
const LEAST_RATE: f64 = 128e3;

/// Returns the maximum time for an object of a size.
fn transfer_timeout(size: usize) -> Duration {
    ANSWER_TIMEOUT + Duration::from_secs_f64(size as f64 / LEAST_RATE)
}

/// Waits for the answer of the store, but not for ever: a bucket may stall without an error.
async fn answer_in_time<T>(
    answer: impl Future<Output = object_store::Result<T>>,
) -> Result<object_store::Result<T>> {
    Ok(tokio::time::timeout(ANSWER_TIMEOUT, answer).await.map_err(ObjectsError::from)?)
}

/// Content of the marker.
const ABOUT: &[u8] = b"The objects of a Sistership store, named by the SHA-256 of their bytes.\n";
/// Name of the marker of a store, next to its objects.
const MARKER: &str = "about.txt";
/// The folder of all objects.
pub(crate) const FOLDER: &str = "objects";

/// `objects/ab/cdef...`
fn object_path(key: &str) -> Result<ObjectPath> {
    checks::check_sha256("key", key)?;
    // 256 folders by the first byte keep each of them small.
    let (folder, file) = key.split_at(2);
    Ok(ObjectPath::from_iter([FOLDER, folder, file]))
}

fn object_error(key: &str, error: object_store::Error) -> StoreError {
    match error {
        object_store::Error::NotFound { .. } => StoreError::not_found("object", key),
        error => ObjectsError::from(error).into(),
    }
}
