//! The refinement job: its source model, its recipe, and the derivation from it.

use std::sync::Arc;

use sistership_jobs::derive::derive;
use sistership_jobs::recipe;
use sistership_store::Job;

use super::commit::commit;
use super::outcome::{Result, failed};
use super::prepared::{SEARCHED, prepare};
use super::progress::{Progress, tell};
use crate::app::App;
use sistership_jobs::request::RefinementJob;

/// Runs a refinement.
pub(super) async fn run(app: &App, job: &Job, progress: Progress) -> Result<()> {
    let asked: RefinementJob = serde_json::from_str(&job.request).map_err(failed)?;
    tell(&progress, 0.01, "reading the trials")?;
    let prepared = prepare(app, &asked, &progress).await?;
    let step = progress.clone();
    // After a model selection the fit continues at its share, so that the progress never goes back.
    let begun = if prepared.start.ladder.is_some() { SEARCHED } else { 0.1 };
    let scaled = move |done: f64, what: &str| step.tell(begun + (0.9 - begun) * done, what);
    let derived = derive(
        app.archive(),
        &asked.ship,
        &recipe::Recipe::Plain(prepared.recipe.clone()),
        Arc::new(scaled),
    )
    .await?
    .spelled_out()?;
    tell(&progress, 0.92, "writing the report and keeping the version")?;
    commit(app, job, derived, (prepared, &asked.trials)).await
}
