//! What a process does beside its work, at its start and from time to time: it removes what ended
//! processes have left, forgets old keys, and looks whether there is room to write. Where there is
//! none, reading goes on, and this tells when there is some again.

use std::sync::atomic::Ordering;
use std::time::Duration;

use sistership_store::StoreError;

use crate::app::App;

/// How often leftovers are looked for.
const EVERY: Duration = Duration::from_secs(15);
/// How often room is looked for where there was none.
const WITHOUT_ROOM: Duration = Duration::from_secs(2);
/// What an upload needs at least.
const ROOM_BYTES: usize = 64 << 10;

/// Tidies until the server is told to stop.
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

/// Tidies once. What fails is said in the log and tried again.
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

/// Whether the database, the objects and the uploads can be written.
async fn has_room(app: &App) -> Result<bool, StoreError> {
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
