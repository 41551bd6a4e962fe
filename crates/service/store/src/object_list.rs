//! Listing of the object store.

use futures::stream::{self, BoxStream};
use futures::{StreamExt as _, TryStreamExt as _};
use object_store::path::Path as ObjectPath;
use object_store::{ObjectMeta, ObjectStore as _};

use crate::checks;
use crate::error::{Result, StoreError};
use crate::objects::{FOLDER, ObjectStorage};
use crate::objects_error::ObjectsError;

/// Number of concurrent requests to the object store.
pub(crate) const MAX_CONCURRENT: usize = 32;

/// Name of an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ObjectName {
    /// The hash of its bytes, as all objects of the store are named.
    Key(String),
    /// Any other name: the object was not written by the store.
    Stranger(String),
}

/// An object without its bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectHead {
    /// Name.
    pub name: ObjectName,
    /// Size, bytes.
    pub bytes: u64,
    /// Time of the last write by the clock of the object store, microseconds since 1970.
    pub modified_us: i64,
}

impl ObjectStorage {
    /// Streams all objects, in no order.
    pub fn list(&self) -> BoxStream<'_, Result<ObjectHead>> {
        let all = self.store.list(Some(&ObjectPath::from(FOLDER)));
        all.map(|meta| Ok(object_head(&meta.map_err(ObjectsError::from)?))).boxed()
    }

    /// Checks that objects of all the keys exist.
    ///
    /// # Errors
    /// Returns an error that names a missing one.
    pub(crate) async fn check_present(
        &self,
        keys: impl Iterator<Item = String> + Send,
    ) -> Result<()> {
        let there = |key: String| async move {
            if self.exists(&key).await? {
                Ok(())
            } else {
                Err(StoreError::not_found("object", key))
            }
        };
        stream::iter(keys.collect::<Vec<_>>())
            .map(there)
            .buffer_unordered(MAX_CONCURRENT)
            .try_collect()
            .await
    }
}

fn object_head(meta: &ObjectMeta) -> ObjectHead {
    let path = meta.location.as_ref();
    ObjectHead {
        name: object_name(path),
        bytes: meta.size,
        modified_us: meta.last_modified.timestamp_micros(),
    }
}

fn object_name(path: &str) -> ObjectName {
    let key = path
        .strip_prefix(FOLDER)
        .and_then(|rest| rest.strip_prefix('/'))
        .map(|rest| rest.replacen('/', "", 1));
    match key.filter(|key| {
        // The slash must come after the first two digits, otherwise two paths could mean the same
        // key.
        checks::check_sha256("key", key).is_ok()
            && path.as_bytes().get(FOLDER.len() + 3) == Some(&b'/')
    }) {
        Some(key) => ObjectName::Key(key),
        None => ObjectName::Stranger(path.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_hashes_in_their_folders_are_keys() {
        let key = "ab".to_owned() + &"0".repeat(62);
        assert_eq!(object_name(&format!("objects/ab/{}", &key[2..])), ObjectName::Key(key.clone()));
        for other in [
            format!("objects/abc/{}", &key[3..]),
            format!("objects/{key}"),
            "objects/ab/x".into(),
            "other".into(),
        ] {
            assert_eq!(object_name(&other), ObjectName::Stranger(other.clone()));
        }
    }
}
