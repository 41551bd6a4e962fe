//! Update of the search index of ships.

use std::sync::Arc;

use sistership_model::Zoo;
use sistership_store::StoreError;

use super::facts;
use crate::archive::Archive;
use crate::catalogue::ZooCache;

/// Number of ships whose facts are written at once.
const WRITE_BATCH: i64 = 50;
/// Number of passes over ships that change meanwhile; the rest waits for the next update.
const MAX_PASSES: usize = 3;

/// Updates the facts of every ship that has changed, for a program that searches without a server.
///
/// # Errors
/// Returns an error if the database does not answer.
pub async fn update_index(archive: &Archive) -> Result<(), StoreError> {
    let laws = ZooCache::default().zoo_of_laws(&archive.store).await?;
    write_facts(archive, &laws).await
}

/// Updates the facts of every ship that has changed, again for one that changes meanwhile: the
/// first publication of its models creates a champion.
///
/// # Errors
/// Returns an error if the database does not answer.
pub async fn write_facts(archive: &Archive, laws: &Arc<Zoo>) -> Result<(), StoreError> {
    for _ in 0..MAX_PASSES {
        if write_waiting(archive, laws).await? == 0 {
            break;
        }
    }
    Ok(())
}

/// Processes the waiting ships once; returns the number that still wait.
async fn write_waiting(archive: &Archive, laws: &Arc<Zoo>) -> Result<usize, StoreError> {
    let (mut after, mut left) = (String::new(), 0);
    loop {
        let waiting = archive.store.search_index().list_stale(&after, WRITE_BATCH).await?;
        let Some(last) = waiting.last() else { return Ok(left) };
        after.clone_from(&last.ship);
        let known = facts::compute_facts(archive, laws, waiting).await?;
        // A ship that changed after it was read is not written and waits for the next pass.
        left += known.len() - archive.store.search_index().write_facts(&known).await?;
    }
}
