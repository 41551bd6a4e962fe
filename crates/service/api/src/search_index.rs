//! Background task that keeps the search index of ships up to date.

use std::time::Duration;

use sistership_jobs::search::write_facts;
use sistership_store::StoreError;

use crate::app::App;

/// Pause after a failure of the database.
const RETRY_DELAY: Duration = Duration::from_secs(5);

/// Writes the facts of ships as they change, until the server stops.
pub(crate) async fn run_loop(app: App) {
    let mut stopping = app.stop_signal();
    let mut read = false;
    // A failure is logged and tried again after a longer pause; the index only falls behind
    // meanwhile.
    while !stopping.is_stopping() {
        let work = update_index(&app, &mut read);
        let mut pause = app.leases().poll;
        tokio::select! {
            done = work => if let Err(error) = done {
                tracing::error!(%error, "the search index of ships could not be updated");
                pause = pause.max(RETRY_DELAY);
            },
            () = stopping.wait() => return,
        }
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = stopping.wait() => {}
        }
    }
}

/// Writes the facts of the ships that wait for it. If none waits, reads the vectors that have
/// changed, once, so that an import of many ships does not cause a read after each.
async fn update_index(app: &App, read: &mut bool) -> Result<(), StoreError> {
    if app.store().search_index().list_stale("", 1).await?.is_empty() {
        if !*read {
            app.catalogue().known_vectors().refresh_all(app.store()).await?;
        }
        *read = true;
        return Ok(());
    }
    *read = false;
    let laws = app.stored_laws().await?;
    write_facts(app.archive(), &laws).await
}
