//! Maintenance of a process, at its start and from time to time: it removes what ended processes
//! have left, deletes old idempotency keys, and checks whether there is space to write. Without
//! space, reading goes on, and this task finds out when there is some again.

use std::sync::atomic::Ordering;
use std::time::Duration;

use sistership_store::StoreError;

use crate::app::App;

/// Interval of the maintenance.
const EVERY: Duration = Duration::from_secs(15);
/// Interval of the check for space while there is none.
const WITHOUT_ROOM: Duration = Duration::from_secs(2);
/// Least space that an upload needs, bytes.
const ROOM_BYTES: usize = 64 << 10;

/// Runs the maintenance until the server stops.
pub(crate) async fn keep(app: App) {
    let mut stopping = app.stopping();
    while !stopping.now() {
        let pause = if app.no_room().load(Ordering::Relaxed) { WITHOUT_ROOM } else { EVERY };
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = stopping.wait() => return,
        }
        tokio::select! {
            () = once(&app) => {}
            () = stopping.wait() => return,
        }
    }
}

/// Runs the maintenance once. Failures are logged, and the next run tries again.
pub(crate) async fn once(app: &App) {
    app.sessions().tidy();
    let inner = app.clone();
    let cleared = tokio::task::spawn_blocking(move || inner.spool().clear()).await;
    if let Ok(Err(error)) = cleared {
        tracing::warn!(%error, "the uploads of ended processes could not be removed");
    }
    if let Err(error) = app.objects().clear_staged().await {
        tracing::warn!(%error, "what ended processes have left of objects could not be removed");
    }
    look_for_room(app).await;
}

async fn look_for_room(app: &App) {
    let found = has_room(app).await;
    // Only a change is logged.
    let before = app.no_room().load(Ordering::Relaxed);
    match found {
        Ok(true) if before => tracing::info!("there is room to write again"),
        Ok(false) if !before => tracing::error!(
            "there is no room to write; reading goes on, and writing once there is room"
        ),
        Err(error) => {
            return tracing::warn!(%error, "whether there is room to write could not be found out");
        }
        _ => {}
    }
    app.no_room().store(matches!(found, Ok(false)), Ordering::Relaxed);
}

/// Returns true if the database, the object store and the uploads can be written.
async fn has_room(app: &App) -> Result<bool, StoreError> {
    // The first step that fails for lack of space decides.
    let written = async {
        app.objects().mark().await?;
        app.store().idempotency().purge().await?;
        app.store().reserve()?;
        app.store().try_write().await
    };
    match written.await {
        Err(error) if error.is_out_of_space() => return Ok(false),
        other => other?,
    }
    let inner = app.clone();
    let room = tokio::task::spawn_blocking(move || inner.spool().has_room(ROOM_BYTES)).await;
    Ok(room
        .map_err(sistership_store::ObjectsError::from)?
        .map_err(sistership_store::ObjectsError::from)?)
}
