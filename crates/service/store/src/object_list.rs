//! What there is in the object store.

use futures::stream::{self, BoxStream};
use futures::{StreamExt as _, TryStreamExt as _};
use object_store::path::Path as ObjectPath;
use object_store::{ObjectMeta, ObjectStore as _};

use crate::checks;
use crate::error::{Result, StoreError};
use crate::objects::{FOLDER, Objects};
use crate::objects_error::ObjectsError;

/// How many objects are asked after at a time.
pub(crate) const AT_ONCE: usize = 32;

/// What an object is called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ObjectName {
    /// By the hash of its bytes, as every object must be.
    Key(String),
    /// Something else; the store has not put it there.
    Stranger(String),
}

/// An object, but for its bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectHead {
    /// What it is called.
    pub name: ObjectName,
    /// Its size.
    pub bytes: u64,
    /// When it was last put, microseconds since 1970 by the clock of the object store.
    pub modified_us: i64,
}

impl Objects {
    /// Every object, in no order.
    pub fn list(&self) -> BoxStream<'_, Result<ObjectHead>> {
        let all = self.store.list(Some(&ObjectPath::from(FOLDER)));
        all.map(|meta| Ok(head(&meta.map_err(ObjectsError::from)?))).boxed()
    }

    /// Checks that all of the keys are there.
    ///
    /// # Errors
    /// Names the first one that is not.
    pub(crate) async fn must_have(&self, keys: impl Iterator<Item = String> + Send) -> Result<()> {
        let there = |key: String| async move {
            if self.exists(&key).await? { Ok(()) } else { Err(StoreError::missing("object", key)) }
        };
        stream::iter(keys.collect::<Vec<_>>())
            .map(there)
            .buffer_unordered(AT_ONCE)
            .try_collect()
            .await
    }
}

fn head(meta: &ObjectMeta) -> ObjectHead {
    let path = meta.location.as_ref();
    ObjectHead {
        name: name(path),
        bytes: meta.size,
        modified_us: meta.last_modified.timestamp_micros(),
    }
}

fn name(path: &str) -> ObjectName {
    let key = path
        .strip_prefix(FOLDER)
        .and_then(|rest| rest.strip_prefix('/'))
        .map(|rest| rest.replacen('/', "", 1));
    match key.filter(|key| {
        checks::sha256("key", key).is_ok() && path.as_bytes().get(FOLDER.len() + 3) == Some(&b'/')
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
        assert_eq!(name(&format!("objects/ab/{}", &key[2..])), ObjectName::Key(key.clone()));
        for other in [
            format!("objects/abc/{}", &key[3..]),
            format!("objects/{key}"),
            "objects/ab/x".into(),
            "other".into(),
        ] {
            assert_eq!(name(&other), ObjectName::Stranger(other.clone()));
        }
    }
}
