//! Lookups in an archive where a missing row is not an error.

use sistership_store::{MAX_LIMIT, PageRequest, StoreError};

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
    let mut all = Vec::new();
    let mut page = PageRequest::first_page(MAX_LIMIT);
    loop {
        let listed = archive.store.ships().list_revisions(name, &page).await;
        let Some(listed) = optional(listed)? else { return Ok(all) };
        all.extend(listed.items.into_iter().map(|revision| ShipRevision {
            title: revision.title,
            category: revision.category,
            document: revision.document,
        }));
        let Some(next) = listed.next else { break };
        page = PageRequest::after_key(next, MAX_LIMIT);
    }
    all.reverse();
    Ok(all)
}
