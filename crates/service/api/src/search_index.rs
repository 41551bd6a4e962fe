//! Keeping up what ships are found by.

use std::time::Duration;

use sistership_jobs::search::write_facts;
use sistership_store::StoreError;

use crate::app::App;

/// A pause after the database has failed.
const BREATH: Duration = Duration::from_secs(5);

/// Writes the facts of ships as they change, until the server is told to stop.
pub(crate) async fn keep(app: App) {
    let mut stopping = app.stopping();
    let mut read = false;
    while !stopping.now() {
        let work = round(&app, &mut read);
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

/// Writes the facts of the ships that wait. When none does, the vectors are read that have changed
/// since they were `read`: not after every ship of many that are brought in one by one.
async fn round(app: &App, read: &mut bool) -> Result<(), StoreError> {
    if app.store().search_index().waiting("", 1).await?.is_empty() {
        if !*read {
            app.catalogue().vectors().catch_up(app.store()).await?;
        }
        *read = true;
        return Ok(());
    }
    *read = false;
    let laws = app.laws().await?;
    write_facts(app.archive(), &laws).await
}
