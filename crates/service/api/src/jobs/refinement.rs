//! The refinement job: its source model, its recipe, and the derivation from it.

use std::sync::Arc;

use sistership_jobs::derive::derive;
use sistership_jobs::recipe;
use sistership_store::Job;

use super::commit::commit_refinement;
use super::outcome::{Result, permanent_failure};
use super::prepared::{SELECTION_SHARE, prepare_refinement};
use super::progress::{JobProgress, report_progress};
use crate::app::App;
use sistership_jobs::request::RefinementJob;

/// Runs a refinement.
pub(super) async fn run_refinement(app: &App, job: &Job, progress: JobProgress) -> Result<()> {
    let asked: RefinementJob = serde_json::from_str(&job.request).map_err(permanent_failure)?;
    report_progress(&progress, 0.01, "reading the trials")?;
    let prepared = prepare_refinement(app, &asked, &progress).await?;
    let step = progress.clone();
    // After a model selection the fit continues at its share, so that the progress never goes back.
    let begun = if prepared.start.ladder.is_some() { SELECTION_SHARE } else { 0.1 };
    let scaled = move |done: f64, what: &str| step.report(begun + (0.9 - begun) * done, what);
    let derived = derive(
        app.archive(),
        &asked.ship,
        &recipe::DerivationRecipe::Plain(prepared.recipe.clone()),
        Arc::new(scaled),
    )
    .await?
    .with_explicit_settings()?;
    report_progress(&progress, 0.92, "writing the report and storing the version")?;
    commit_refinement(app, job, derived, (prepared, &asked.trials)).await
}
