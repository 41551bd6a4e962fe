//! Keeping up what ships are found by.

use std::sync::Arc;
use std::time::Duration;

use sistership_model::Zoo;
use sistership_store::StoreError;

use super::facts;
use crate::app::App;
use crate::archive::Archive;
use crate::catalogue::Catalogue;

/// Ships whose facts are written at once.
const AT_ONCE: i64 = 50;
/// A pause after the database has failed.
const BREATH: Duration = Duration::from_secs(5);
/// How often ships that keep changing are tried; then it is the next time's turn.
const PASSES: usize = 3;

/// Writes the facts of ships as they change, until the server is told to stop.
pub(crate) async fn keep(app: App) {
    let mut stopping = app.stopping();
    while !stopping.now() {
        let work = async {
            let laws = app.laws().await?;
            all(app.archive(), &laws).await
        };
        let mut pause = app.leases().poll;
        tokio::select! {
            done = work => if let Err(error) = done {
                tracing::error!(%error, "what ships are found by could not be written");
                pause = pause.max(BREATH);
            },
            () = stopping.wait() => return,
        }
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = stopping.wait() => {}
        }
    }
}

/// Writes the facts of every ship that has changed, for a program that searches without a server.
///
/// # Errors
/// The database does not answer.
pub async fn catch_up(archive: &Archive) -> Result<(), StoreError> {
    let laws = Catalogue::default().laws(&archive.store).await?;
    all(archive, &laws).await
}

/// Again where a ship has changed meanwhile: the first time that her models are published makes her a champion.
async fn all(archive: &Archive, laws: &Arc<Zoo>) -> Result<(), StoreError> {
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
