//! Lookups in an archive where a missing row is not an error.

use sistership_store::{StoreError, read_all_pages};

use super::content::ShipRevision;
use super::error::BundleError;
use crate::archive::Archive;

type Result<T> = std::result::Result<T, BundleError>;

/// Converts "not found" to `None`.
pub fn optional<T>(result: std::result::Result<T, StoreError>) -> Result<Option<T>> {
    match result {
        Ok(found) => Ok(Some(found)),
        Err(StoreError::NotFound { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Returns the revisions of a ship, oldest first; empty if there is no such ship.
pub async fn ship_revisions(archive: &Archive, name: &str) -> Result<Vec<ShipRevision>> {
    let ships = archive.store.ships();
    let listed =
        read_all_pages(|page| async move { ships.list_revisions(name, &page).await }).await;
    let revisions = optional(listed)?.unwrap_or_default();
    // The store lists the newest first.
    let record = |revision: sistership_store::ShipRevision| ShipRevision {
        title: revision.title,
        category: revision.category,
        document: revision.document,
    };
    Ok(revisions.into_iter().rev().map(record).collect())
}
