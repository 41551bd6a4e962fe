//! The example as a first step: the ship and the trials of `sistership demo`, by the code that
//! stores those of a person.

use axum::extract::State;
use axum::response::Response;
use bytes::Bytes;
use futures::stream;
use sistership_jobs::example;
use sistership_model::manifest::Manifest;
use sistership_model::{Trial, Vessel, Zoo};
use sistership_store::StoreError;

use super::super::ship_changes::store_ship;
use super::answer::redirect_to;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::upload::{SpooledFile, TrialUpload, spool_stream, store_upload};
use crate::web::form::PageForm;

/// Adds the ship with its trials unless it is there, and leads to it.
pub(super) async fn load_example(
    State(app): State<App>,
    PageForm(_): PageForm,
) -> Result<Response> {
    match app.store().ships().get(example::SHIP_NAME).await {
        Err(StoreError::NotFound { .. }) => {
            let vessel = Vessel::parse("example", example::SHIP_YAML)?;
            store_ship(&app, &vessel).await?;
        }
        other => drop(other?),
    }
    // Samples that are there already are not stored again.
    let trials = app.run_blocking(record_trials).await??;
    store_upload(&app, spool_trials(&app, &trials).await?).await?;
    Ok(redirect_to(&format!("/ships/{}", example::SHIP_NAME)))
}

fn record_trials() -> Result<Vec<Trial>> {
    let zoo = Zoo::load_embedded()?;
    example::record_trials(&zoo).map_err(Problem::internal)
}

/// Returns the trials as an upload of files.
async fn spool_trials(app: &App, trials: &[Trial]) -> Result<TrialUpload> {
    let mut files: Vec<(String, SpooledFile)> = Vec::new();
    for (name, bytes) in example::trial_files(trials).map_err(Problem::internal)? {
        let whole = stream::iter([Ok::<_, Problem>(Bytes::from(bytes))]);
        files.push((name, spool_stream(app.spool(), whole).await?));
    }
    let manifest: Manifest =
        serde_json::from_value(example::trial_manifest(trials)).map_err(Problem::internal)?;
    TrialUpload::from_listed(manifest.into(), files)
}
