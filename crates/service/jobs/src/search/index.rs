//! Keeping up what ships are found by.

use std::sync::Arc;

use sistership_model::Zoo;
use sistership_store::StoreError;

use super::facts;
use crate::archive::Archive;
use crate::catalogue::Catalogue;

/// Ships whose facts are written at once.
const AT_ONCE: i64 = 50;
/// How often ships that keep changing are tried; then it is the next time's turn.
const PASSES: usize = 3;

/// Writes the facts of every ship that has changed, for a program that searches without a server.
///
/// # Errors
/// The database does not answer.
pub async fn catch_up(archive: &Archive) -> Result<(), StoreError> {
    let laws = Catalogue::default().laws(&archive.store).await?;
    write_facts(archive, &laws).await
}

/// Writes the facts of every ship that has changed, again where one has changed meanwhile: the
/// first time that its models are published makes it a champion.
///
/// # Errors
/// The database does not answer.
pub async fn write_facts(archive: &Archive, laws: &Arc<Zoo>) -> Result<(), StoreError> {
    for _ in 0..PASSES {
        if pass(archive, laws).await? == 0 {
            break;
        }
    }
    Ok(())
}

/// Goes through the ships that wait once, and returns how many it has left waiting.
async fn pass(archive: &Archive, laws: &Arc<Zoo>) -> Result<usize, StoreError> {
    let (mut after, mut left) = (String::new(), 0);
    loop {
        let waiting = archive.store.search_index().waiting(&after, AT_ONCE).await?;
        let Some(last) = waiting.last() else { return Ok(left) };
        after.clone_from(&last.ship);
        let known = facts::of_ships(archive, laws, waiting).await?;
        left += known.len() - archive.store.search_index().write(&known).await?;
    }
}
