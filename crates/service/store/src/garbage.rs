//! Objects that no row refers to: what is left of uploads that were refused or broke off between
//! object and row.

use futures::stream::{self, StreamExt as _, TryStreamExt as _};

use crate::arguments::args;
use crate::database::Transaction;
use crate::error::Result;
use crate::object_list::AT_ONCE;
use crate::objects::Objects;
use crate::record::Counted;
use crate::statements::{pair, same, statements};
use crate::store::Store;

statements! {
    // Keeps new trials and versions out until the end of the transaction; on SQLite its begin has
    // done so.
    LOCK = pair("SELECT 1 WHERE FALSE", "LOCK TABLE trials, versions IN SHARE ROW EXCLUSIVE MODE");
    REFERRED = same("SELECT (SELECT COUNT(*) FROM trials WHERE object_key = $1) \
        + (SELECT COUNT(*) FROM versions WHERE weights_key = $1) AS rows");
}

impl Store {
    /// Those of the keys that no trial, deleted or not, and no version refers to.
    pub async fn unreferred(&self, keys: &[String]) -> Result<Vec<String>> {
        let mut tx = self.begin().await?;
        unreferred(&mut tx, keys).await
    }

    /// Removes the objects of those keys that no trial and no version refers to, and returns these
    /// keys. None is put in meanwhile, and [`crate::Trials::insert_all_and_enqueue`] and
    /// [`Store::commit_refinement`] look for their objects after they have waited for this:
    /// neither order leaves a trial without samples, or a branch without weights.
    pub async fn remove_unreferred(
        &self,
        objects: &Objects,
        keys: &[String],
    ) -> Result<Vec<String>> {
        let mut tx = self.begin().await?;
        tx.execute(LOCK, &[]).await?;
        let removed = unreferred(&mut tx, keys).await?;
        let removal = |key: &String| objects.remove(key.clone());
        stream::iter(removed.iter().map(removal).collect::<Vec<_>>())
            .buffer_unordered(AT_ONCE)
            .try_collect::<()>()
            .await?;
        tx.commit().await?;
        Ok(removed)
    }
}

async fn unreferred(tx: &mut Transaction, keys: &[String]) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for key in keys {
        let referred: Counted = tx.one(REFERRED, args![object_key: key]).await?;
        if referred.rows == 0 {
            found.push(key.clone());
        }
    }
    Ok(found)
}
