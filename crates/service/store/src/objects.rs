//! Objects: bytes named by their SHA-256, in a local folder or in a bucket of an S3-compatible
//! store, see [`crate::ObjectsPlace`].
//!
//! What [`Objects::put`] has acknowledged is durable, so that a row may refer to it: on the disk,
//! folder entries included, or by the word of the bucket's server.

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

/// A content-addressed store. A clone is another handle on the same one.
#[derive(Debug, Clone)]
pub struct Objects {
    pub(crate) store: Arc<dyn ObjectStore>,
    /// The folder, where it is one.
    pub(crate) folder: Option<PathBuf>,
}

impl Objects {
    /// Objects below the folder `root`, which is made if it is not there.
    pub fn local(root: &Path) -> Result<Self> {
        folders::make(root).map_err(ObjectsError::from)?;
        let store = LocalFileSystem::new_with_prefix(root).map_err(ObjectsError::from)?;
        Ok(Self { store: Arc::new(store.with_fsync(true)), folder: Some(root.to_path_buf()) })
    }

    /// Objects that go with the process.
    pub fn memory() -> Self {
        Self::over(Arc::new(InMemory::new()))
    }

    /// Objects in any store.
    pub fn over(store: Arc<dyn ObjectStore>) -> Self {
        Self { store, folder: None }
    }

    /// Leaves the mark that [`health`](Self::health) looks for, where it is not there yet: a folder
    /// that is no longer mounted does not have it.
    pub async fn mark(&self) -> Result<()> {
        if self.store.head(&ObjectPath::from(MARK)).await.is_ok() {
            return Ok(());
        }
        let about = PutPayload::from_static(
            b"The objects of a Sistership store, named by the SHA-256 of their bytes.\n",
        );
        self.store.put(&ObjectPath::from(MARK), about).await.map_err(ObjectsError::from)?;
        Ok(())
    }

    /// Whether the store answers in time and is the one that was [marked](Self::mark).
    pub async fn health(&self) -> Result<()> {
        let mark = ObjectPath::from(MARK);
        let looked = tokio::time::timeout(PATIENCE, self.store.head(&mark)).await;
        looked.map_err(ObjectsError::from)?.map(drop).map_err(|error| failure(MARK, error))
    }

    /// Keeps the bytes and returns their key, once they are durable. They are written even when the
    /// key is there: another writer may not have made them durable yet, and a damaged object is
    /// healed.
    pub async fn put(&self, bytes: Bytes) -> Result<String> {
        let key = hash(bytes.clone()).await?;
        let _held = self.putting().await?;
        let (at, size) = (path(&key)?, bytes.len());
        let put = self.store.put(&at, PutPayload::from(bytes));
        tokio::time::timeout(patience(size), put)
            .await
            .map_err(ObjectsError::from)?
            .map_err(ObjectsError::from)?;
        Ok(key)
    }

    /// The bytes of this key, verified.
    pub async fn get(&self, key: &str) -> Result<Bytes> {
        let at = path(key)?;
        let found = tokio::time::timeout(ANSWER, self.store.get(&at)).await;
        let found = found.map_err(ObjectsError::from)?.map_err(|error| failure(key, error))?;
        let size = usize::try_from(found.meta.size).unwrap_or(usize::MAX);
        let bytes = tokio::time::timeout(patience(size), found.bytes()).await;
        let bytes = bytes.map_err(ObjectsError::from)?.map_err(|error| failure(key, error))?;
        let actual = hash(bytes.clone()).await?;
        match actual == key {
            true => Ok(bytes),
            false => Err(ObjectsError::Damaged { key: key.to_owned(), actual }.into()),
        }
    }

    /// The bytes of this key as they come, not yet verified: whoever reads them to the end compares
    /// their hash.
    ///
    /// # Errors
    /// There is no such object, or the store fails.
    pub async fn stream(&self, key: &str) -> Result<(u64, BoxStream<'static, Result<Bytes>>)> {
        let found = self.store.get(&path(key)?).await.map_err(|error| failure(key, error))?;
        let (size, key) = (found.meta.size, key.to_owned());
        Ok((size, found.into_stream().map_err(move |error| failure(&key, error)).boxed()))
    }

    /// Removes the object of this key, if it is there. Only who knows that no row refers to it may
    /// do so, see [`crate::Store::remove_unreferred`].
    pub(crate) async fn remove(&self, key: String) -> Result<()> {
        match self.store.delete(&path(&key)?).await {
            Ok(()) | Err(object_store::Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(ObjectsError::from(error).into()),
        }
    }

    /// Size of the object of this key, bytes.
    pub async fn size(&self, key: &str) -> Result<u64> {
        Ok(self.store.head(&path(key)?).await.map_err(|error| failure(key, error))?.size)
    }

    /// Whether there is an object of this key.
    pub async fn exists(&self, key: &str) -> Result<bool> {
        match self.store.head(&path(key)?).await {
            Ok(_) => Ok(true),
            Err(object_store::Error::NotFound { .. }) => Ok(false),
            Err(error) => Err(ObjectsError::from(error).into()),
        }
    }
}

/// The SHA-256 of bytes in lower-case hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The hash, computed where it holds nobody up.
async fn hash(bytes: Bytes) -> Result<String, ObjectsError> {
    Ok(tokio::task::spawn_blocking(move || sha256_hex(&bytes)).await?)
}

/// How long a look at the mark may take: whoever asks whether the server is ready waits for it.
const PATIENCE: Duration = Duration::from_millis(800);
/// How long the store may take to answer, what it repeats included.
const ANSWER: Duration = Duration::from_secs(20);
/// Bytes a second that it must take or give then, the least of any link in use.
const LEAST_RATE: f64 = 128e3;

/// How long an object of so many bytes may take.
fn patience(size: usize) -> Duration {
    ANSWER + Duration::from_secs_f64(size as f64 / LEAST_RATE)
}

/// What every store of ours has beside its objects.
const MARK: &str = "about.txt";
/// The folder of all objects.
pub(crate) const FOLDER: &str = "objects";

/// `objects/ab/cdef...`
fn path(key: &str) -> Result<ObjectPath> {
    checks::sha256("key", key)?;
    let (folder, file) = key.split_at(2);
    Ok(ObjectPath::from_iter([FOLDER, folder, file]))
}

fn failure(key: &str, error: object_store::Error) -> StoreError {
    match error {
        object_store::Error::NotFound { .. } => StoreError::missing("object", key),
        error => ObjectsError::from(error).into(),
    }
}
