//! Maintenance of a process, at its start and from time to time: it removes what ended processes
//! have left, deletes old idempotency keys, and checks whether there is space to write. Without
//! space, reading goes on, and this task finds out when there is some again.

use std::sync::atomic::Ordering;
use std::time::Duration;

use sistership_store::StoreError;

use crate::app::App;

/// Interval of the maintenance.
const MAINTENANCE_INTERVAL: Duration = Duration::from_secs(15);
/// Interval of the check for space while there is none.
const SPACE_CHECK_INTERVAL: Duration = Duration::from_secs(2);
/// Least space that an upload needs, bytes.
const ROOM_BYTES: usize = 64 << 10;

/// Runs the maintenance until the server stops.
pub(crate) async fn run_loop(app: App) {
    let mut stopping = app.stop_signal();
    while !stopping.is_stopping() {
        let pause = if app.is_out_of_space().load(Ordering::Relaxed) {
            SPACE_CHECK_INTERVAL
        } else {
            MAINTENANCE_INTERVAL
        };
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = stopping.wait() => return,
        }
        tokio::select! {
            () = run_once(&app) => {}
            () = stopping.wait() => return,
        }
    }
}

/// Runs the maintenance once. Failures are logged, and the next run tries again.
pub(crate) async fn run_once(app: &App) {
    app.sessions().remove_idle();
    let inner = app.clone();
    let cleared = tokio::task::spawn_blocking(move || inner.spool().clear_ended()).await;
    if let Ok(Err(error)) = cleared {
        tracing::warn!(%error, "the uploads of ended processes could not be removed");
    }
    if let Err(error) = app.objects().clear_staged().await {
        tracing::warn!(%error, "unfinished objects of ended processes could not be removed");
    }
    check_free_space(app).await;
}

async fn check_free_space(app: &App) {
    let found = has_free_space(app).await;
    // Only a change is logged.
    let before = app.is_out_of_space().load(Ordering::Relaxed);
    match found {
        Ok(true) if before => tracing::info!("there is free space to write again"),
        Ok(false) if !before => tracing::error!(
            "there is no free space to write; reading continues, and writing will as soon as \
             there is space"
        ),
        Err(error) => {
            return tracing::warn!(%error, "the free space could not be determined");
        }
        _ => {}
    }
    app.is_out_of_space().store(matches!(found, Ok(false)), Ordering::Relaxed);
}

/// Returns true if the database, the object store and the uploads can be written.
async fn has_free_space(app: &App) -> Result<bool, StoreError> {
    // The first step that fails for lack of space decides.
    let written = async {
        app.objects().write_marker().await?;
        app.store().idempotency().purge_expired().await?;
        app.store().reserve_space()?;
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
