//! Objects that no row refers to: leftovers of uploads that were refused, or that failed between
//! the object and the row.

use futures::stream::{self, StreamExt as _, TryStreamExt as _};

use crate::arguments::args;
use crate::database::AuditedTransaction;
use crate::error::Result;
use crate::object_list::MAX_CONCURRENT;
use crate::objects::ObjectStorage;
use crate::record::RowCount;
use crate::statements::{pair, same, statements};
use crate::store::Store;

statements! {
    // Blocks the insertion of trials and versions until the end of the transaction; on SQLite the
    // write lock of the transaction does so.
    LOCK = pair("SELECT 1 WHERE FALSE", "LOCK TABLE trials, versions IN SHARE ROW EXCLUSIVE MODE");
    // The lock is held until the last object has been removed, however long the bucket takes.
    HOLD = pair("SELECT 1 WHERE FALSE", "SET LOCAL idle_in_transaction_session_timeout = 0");
    REFERRED = same("SELECT (SELECT COUNT(*) FROM trials WHERE object_key = $1) \
        + (SELECT COUNT(*) FROM versions WHERE weights_key = $1) AS rows");
}

impl Store {
    /// Returns the keys that no trial, deleted or not, and no version refers to.
    pub async fn unreferenced_keys(&self, keys: &[String]) -> Result<Vec<String>> {
        let mut tx = self.begin().await?;
        find_unreferenced(&mut tx, keys).await
    }

    /// Removes the objects that no trial and no version refers to, and returns their keys. No row
    /// is inserted meanwhile, and [`crate::Trials::insert_all_and_enqueue`] and
    /// [`Store::commit_refinement`] check for their objects after they have waited for this: in
    /// either order no trial loses its samples, and no learned correction its weights.
    pub async fn remove_unreferenced(
        &self,
        objects: &ObjectStorage,
        keys: &[String],
    ) -> Result<Vec<String>> {
        let mut tx = self.begin().await?;
        tx.execute(HOLD, &[]).await?;
        tx.execute(LOCK, &[]).await?;
        let removed = find_unreferenced(&mut tx, keys).await?;
        let removal = |key: &String| objects.remove_object(key.clone());
        // Removed before the commit, while the lock still excludes new references.
        stream::iter(removed.iter().map(removal).collect::<Vec<_>>())
            .buffer_unordered(MAX_CONCURRENT)
            .try_collect::<()>()
            .await?;
        tx.commit().await?;
        Ok(removed)
    }
}

async fn find_unreferenced(tx: &mut AuditedTransaction, keys: &[String]) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for key in keys {
        // One statement for each key: both columns have an index.
        let referred: RowCount = tx.fetch_one(REFERRED, args![object_key: key]).await?;
        if referred.rows == 0 {
            found.push(key.clone());
        }
    }
    Ok(found)
}
