//! Keeping up what ships are found by.

use std::time::Duration;

use sistership_pipeline::search::write_facts;

use crate::app::App;

/// A pause after the database has failed.
const BREATH: Duration = Duration::from_secs(5);

/// Writes the facts of ships as they change, until the server is told to stop.
pub(crate) async fn keep(app: App) {
    let mut stopping = app.stopping();
    while !stopping.now() {
        let work = async {
            let laws = app.laws().await?;
            write_facts(app.archive(), &laws).await
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
