//! Ships: the present document with its revision, and all documents before it.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::search_index;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    // A conflict on the name returns no row, also if the ship of that name is deleted.
    INSERT = same("INSERT INTO ships (name, title, category, document, revision, created_us, \
        updated_us) VALUES ($1, $2, $3, $4, 1, $5, $5) ON CONFLICT (name) DO NOTHING \
        RETURNING name, title, category, document, revision, created_us, updated_us, deleted_us");
    // Compare-and-swap: the condition on the revision makes a lost update impossible.
    UPDATE = same("UPDATE ships SET title = $3, category = $4, document = $5, revision = revision \
        + 1, updated_us = $6 WHERE name = $1 AND revision = $2 AND deleted_us IS NULL \
        RETURNING name, title, category, document, revision, created_us, updated_us, deleted_us");
    DELETE = same("UPDATE ships SET deleted_us = $3 \
        WHERE name = $1 AND revision = COALESCE($2, revision) AND deleted_us IS NULL \
        RETURNING name, title, category, document, revision, created_us, updated_us, deleted_us");
    UNDELETE = same("UPDATE ships SET deleted_us = NULL WHERE name = $1 AND deleted_us IS NOT NULL \
        RETURNING name, title, category, document, revision, created_us, updated_us, deleted_us");
    // Copies the present row, after the update, into the history.
    REMEMBER = same("INSERT INTO ship_revisions (ship, revision, title, category, document, \
        created_us) SELECT name, revision, title, category, document, updated_us FROM ships WHERE \
        name = $1");
    GET = same("SELECT name, title, category, document, revision, created_us, updated_us, \
        deleted_us FROM ships WHERE name = $1");
    LIST = same("SELECT name, title, category, document, revision, created_us, updated_us, \
        deleted_us FROM ships WHERE name > COALESCE($1, '') AND deleted_us IS NULL ORDER BY name \
        LIMIT $2");
    LIST_CATEGORY = same("SELECT name, title, category, document, revision, created_us, \
        updated_us, deleted_us FROM ships WHERE name > COALESCE($1, '') AND category = $3 AND \
        deleted_us IS NULL ORDER BY name LIMIT $2");
    // Descending list: without a cursor it starts below i64::MAX.
    REVISIONS = same("SELECT ship, revision, title, category, document, created_us FROM \
        ship_revisions WHERE ship = $1 AND revision < COALESCE($2, 9223372036854775807) ORDER BY \
        revision DESC LIMIT $3");
}

record! {
    /// A ship.
    pub struct Ship {
        /// Name, which never changes.
        pub name: String,
        /// Display title.
        pub title: String,
        /// Category: container ship, tanker, ...
        pub category: String,
        /// The vessel as canonical JSON.
        pub document: String,
        /// Revision: 1 at creation, increased by one with each update.
        pub revision: i64,
        /// When it was created.
        pub created_us: i64,
        /// When the present revision was made.
        pub updated_us: i64,
        /// When it was deleted, if it is.
        pub deleted_us: Option<i64>,
    }
}

record! {
    /// A ship at one revision.
    pub struct ShipRevision {
        /// The ship.
        pub ship: String,
        /// The revision.
        pub revision: i64,
        /// Display title.
        pub title: String,
        /// Category.
        pub category: String,
        /// The vessel as canonical JSON.
        pub document: String,
        /// Time of this revision, microseconds since 1970.
        pub created_us: i64,
    }
}

/// Content of a ship to be created or updated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewShip {
    /// Its name.
    pub name: String,
    /// Display title.
    pub title: String,
    /// Category.
    pub category: String,
    /// The vessel as canonical JSON.
    pub document: String,
}

impl NewShip {
    fn check_fields(&self) -> Result<()> {
        checks::check_name("name", &self.name)?;
        checks::check_name("category", &self.category)?;
        checks::check_json("document", &self.document)
    }
}

/// Repository of ships.
#[derive(Debug, Clone, Copy)]
pub struct ShipRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of ships and their history.
    pub fn ships(&self) -> ShipRepository<'_> {
        ShipRepository(self)
    }
}

impl ShipRepository<'_> {
    /// Creates a ship at revision 1; a name that was ever used is a conflict.
    pub async fn create(&self, new: &NewShip) -> Result<Ship> {
        new.check_fields()?;
        let NewShip { name, title, category, document } = new;
        let values = args![name: name, title: title, category: category, document: document,
            created_us: self.0.now_us()];
        let mut tx = self.0.begin().await?;
        let Some(ship) = tx.fetch_optional(INSERT, values).await? else {
            // The name exists; the read shows if the ship was deleted.
            return Err(name_conflict(name, find_ship(&mut tx, name).await));
        };
        tx.execute(REMEMBER, args![name: name]).await?;
        tx.record_audit_event(
            self.0.now_us(),
            "ship.create",
            audit_subject(name),
            None,
            Some(audit_state(&ship)),
        );
        search_index::queue_ship(self.0, &mut tx, name).await?;
        tx.commit().await?;
        Ok(ship)
    }

    /// Returns the ship of a name.
    pub async fn get(&self, name: &str) -> Result<Ship> {
        let ship: Option<Ship> = self.0.database().fetch_optional(GET, args![name: name]).await?;
        require_present(name, ship)
    }

    /// Replaces the content of a ship, if it is still at `revision`.
    pub async fn update(&self, new: &NewShip, revision: i64) -> Result<Ship> {
        new.check_fields()?;
        let NewShip { name, title, category, document } = new;
        let mut tx = self.0.begin().await?;
        let values = args![name: name, revision: revision, title: title, category: category,
            document: document,
            updated_us: self.0.now_us()];
        let before: Option<Ship> = tx.fetch_optional(GET, args![name: name]).await?;
        let Some(ship) = tx.fetch_optional(UPDATE, values).await? else {
            return Err(update_conflict(&mut tx, name).await);
        };
        tx.execute(REMEMBER, args![name: name]).await?;
        let (before, after) = (before.as_ref().map(audit_state), Some(audit_state(&ship)));
        tx.record_audit_event(self.0.now_us(), "ship.update", audit_subject(name), before, after);
        search_index::queue_ship(self.0, &mut tx, name).await?;
        tx.commit().await?;
        Ok(ship)
    }

    /// Deletes a ship, if it is still at `revision` (at any, if none is given);
    /// [`undelete`](Self::undelete) reverts it.
    pub async fn delete(&self, name: &str, revision: Option<i64>) -> Result<Ship> {
        let mut tx = self.0.begin().await?;
        let values = args![name: name, revision: revision, deleted_us: self.0.now_us()];
        let Some(ship) = tx.fetch_optional(DELETE, values).await? else {
            return Err(update_conflict(&mut tx, name).await);
        };
        search_index::queue_ship(self.0, &mut tx, name).await?;
        tx.record_audit_event(
            self.0.now_us(),
            "ship.delete",
            audit_subject(name),
            Some(audit_state(&ship)),
            None,
        );
        tx.commit().await?;
        Ok(ship)
    }

    /// Restores a deleted ship unchanged; one that is not deleted is returned as it is.
    pub async fn undelete(&self, name: &str) -> Result<Ship> {
        let mut tx = self.0.begin().await?;
        let Some(ship) = tx.fetch_optional(UNDELETE, args![name: name]).await? else {
            return find_ship(&mut tx, name).await;
        };
        search_index::queue_ship(self.0, &mut tx, name).await?;
        tx.record_audit_event(
            self.0.now_us(),
            "ship.undelete",
            audit_subject(name),
            None,
            Some(audit_state(&ship)),
        );
        tx.commit().await?;
        Ok(ship)
    }

    /// Lists all ships by name, or those of one category.
    pub async fn list(&self, category: Option<&str>, page: &PageRequest) -> Result<ListPage<Ship>> {
        let (database, limit) = (self.0.database(), page.fetch_limit()?);
        let ships = match category {
            None => database.fetch_all(LIST, args![after: &page.after, limit: limit]).await?,
            Some(category) => {
                database
                    .fetch_all(
                        LIST_CATEGORY,
                        args![after: &page.after, limit: limit, category: category],
                    )
                    .await?
            }
        };
        Ok(page.build_page(ships, |ship: &Ship| ship.name.clone()))
    }

    /// Lists the revisions of a ship, the latest first.
    pub async fn list_revisions(
        &self,
        name: &str,
        page: &PageRequest<i64>,
    ) -> Result<ListPage<ShipRevision, i64>> {
        let values = args![name: name, after: page.after, limit: page.fetch_limit()?];
        let revisions = self.0.database().fetch_all(REVISIONS, values).await?;
        Ok(page.build_page(revisions, |revision: &ShipRevision| revision.revision))
    }
}

/// Returns the subject of audit entries about a ship.
pub(crate) fn audit_subject(name: &str) -> String {
    format!("ship:{name}")
}

/// Returns the state of a ship for the audit; the document is in the history of the ship.
fn audit_state(ship: &Ship) -> Value {
    json!({ "revision": ship.revision, "sha256": sha256_hex(ship.document.as_bytes()) })
}

/// Returns a ship that is not deleted, as the transaction sees it.
pub(crate) async fn find_ship(tx: &mut AuditedTransaction, name: &str) -> Result<Ship> {
    require_present(name, tx.fetch_optional(GET, args![name: name]).await?)
}

fn require_present(name: &str, ship: Option<Ship>) -> Result<Ship> {
    ship.filter(|ship| ship.deleted_us.is_none()).ok_or_else(|| StoreError::not_found("ship", name))
}

/// Returns the reason why a name cannot be used again.
fn name_conflict(name: &str, holder: Result<Ship>) -> StoreError {
    match holder {
        Ok(_) => StoreError::conflict("ship", name, "exists already"),
        Err(StoreError::NotFound { .. }) => {
            StoreError::conflict("ship", name, "was deleted; undelete it instead")
        }
        Err(error) => error,
    }
}

/// Returns the reason why a compare-and-swap changed no row.
async fn update_conflict(tx: &mut AuditedTransaction, name: &str) -> StoreError {
    match find_ship(tx, name).await {
        Ok(ship) => StoreError::precondition_failed("ship", name, Some(ship.revision)),
        Err(error) => error,
    }
}
