//! Tags: words that users assign to ships, to find them by.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::record::{RowCount, record};
use crate::ships::{self, ShipRepository, audit_subject};
use crate::statements::{pair, same, statements};

/// Maximum number of tags of a ship.
pub const MAX_TAGS: usize = 100;

statements! {
    // Insertions for one ship are serial, so that two of them cannot exceed the maximum together.
    // SQLite has one writer anyway.
    LOCK = pair("SELECT 1 WHERE $1 = ''", "SELECT 1 FROM ships WHERE name = $1 FOR NO KEY UPDATE");
    PUT = same("INSERT INTO ship_tags (ship, tag) VALUES ($1, $2) ON CONFLICT (ship, tag) DO \
        NOTHING");
    REMOVE = same("DELETE FROM ship_tags WHERE ship = $1 AND tag = $2");
    OF_SHIP = same("SELECT tag FROM ship_tags WHERE ship = $1 ORDER BY tag");
    COUNT = same("SELECT COUNT(*) AS rows FROM ship_tags WHERE ship = $1");
}

record! {
    /// A tag of a ship.
    pub struct TagRow {
        /// The word.
        pub tag: String,
    }
}

impl ShipRepository<'_> {
    /// Returns the tags of a ship, in alphabetical order.
    pub async fn list_tags(&self, name: &str) -> Result<Vec<String>> {
        let tags: Vec<TagRow> = self.0.database().fetch_all(OF_SHIP, args![ship: name]).await?;
        Ok(tags.into_iter().map(|tag| tag.tag).collect())
    }

    /// Adds a tag to a ship, which may have at most [`MAX_TAGS`]; an existing tag stays.
    pub async fn add_tag(&self, name: &str, tag: &str) -> Result<()> {
        checks::check_name("tag", tag)?;
        let mut tx = self.0.begin().await?;
        ships::find_ship(&mut tx, name).await?;
        tx.execute(LOCK, args![ship: name]).await?;
        let new = tx.execute(PUT, args![ship: name, tag: tag]).await?;
        // Counted after the insertion, under the lock; too many roll it back.
        check_count(&mut tx, name).await?;
        if new > 0 {
            let after = json!({ "tag": tag });
            tx.record_audit_event(
                self.0.now_us(),
                "ship.tag",
                audit_subject(name),
                None,
                Some(after),
            );
        }
        tx.commit().await
    }

    /// Removes a tag from a ship.
    pub async fn remove_tag(&self, name: &str, tag: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        ships::find_ship(&mut tx, name).await?;
        let removed = tx.execute(REMOVE, args![ship: name, tag: tag]).await?;
        if removed > 0 {
            let before = json!({ "tag": tag });
            tx.record_audit_event(
                self.0.now_us(),
                "ship.untag",
                audit_subject(name),
                Some(before),
                None,
            );
        }
        tx.commit().await?;
        if removed > 0 {
            Ok(())
        } else {
            Err(StoreError::not_found("tag", format!("{name}/{tag}")))
        }
    }
}

async fn check_count(tx: &mut AuditedTransaction, name: &str) -> Result<()> {
    let count: RowCount = tx.fetch_one(COUNT, args![ship: name]).await?;
    match usize::try_from(count.rows).is_ok_and(|rows| rows <= MAX_TAGS) {
        true => Ok(()),
        false => Err(StoreError::conflict(
            "ship",
            name,
            format!("has {MAX_TAGS} tags already, which is the limit"),
        )),
    }
}
