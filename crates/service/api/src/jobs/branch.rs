//! The job that trains a learned correction: its recipe, and the derivation from it.

use std::sync::Arc;

use serde_json::json;
use sistership_jobs::derive::derive;
use sistership_jobs::recipe::DerivationRecipe;
use sistership_jobs::training::{choose_kind, training_recipe};
use sistership_learned::BranchChoice;
use sistership_model::version::RecipeTrial;
use sistership_store::{Job, Version};

use super::commit_branch::commit_training;
use super::outcome::{Result, permanent_failure};
use super::prepared::recipe_trials;
use super::progress::{JobProgress, report_progress};
use crate::app::App;
use sistership_jobs::request::BranchJob;

/// Share of the job's progress that the trial of all kinds of learned correction takes.
const SELECTION_SHARE: f64 = 0.6;

/// Trains a learned correction, if a kind was named or one is selected.
pub(super) async fn run_training(app: &App, job: &Job, progress: JobProgress) -> Result<()> {
    let asked: BranchJob = serde_json::from_str(&job.request).map_err(permanent_failure)?;
    report_progress(&progress, 0.01, "reading the trials")?;
    let version = app.store().versions().get(&asked.ship, asked.number).await?;
    let trials = recipe_trials(app, &asked.trials).await?;
    let (mut settings, mut choice) = (asked.settings.clone(), None);
    // Without a kind in the settings, every kind is evaluated on held-out trials first.
    if settings.is_open() {
        let tried = select_kind(app, &asked, &version, &trials, &progress).await?;
        let Some(kind) = tried.taken else {
            return complete_without_version(app, job, &asked, &tried).await;
        };
        (settings, choice) = (settings.with_kind(kind), Some(tried));
    }
    let recipe = training_recipe(app.archive(), &version, trials, &settings).await?;
    // The fit continues where the selection ended, so that the progress never goes back.
    let (step, begun) = (progress.clone(), if choice.is_some() { SELECTION_SHARE } else { 0.05 });
    let scaled = move |done: f64, what: &str| step.report(begun + (0.9 - begun) * done, what);
    let recipe = DerivationRecipe::Training(recipe);
    let derived = derive(app.archive(), &asked.ship, &recipe, Arc::new(scaled)).await?;
    report_progress(&progress, 0.92, "storing the weights and the version")?;
    commit_training(app, job, derived, &version.head, choice).await
}

async fn select_kind(
    app: &App,
    asked: &BranchJob,
    version: &Version,
    trials: &[RecipeTrial],
    progress: &JobProgress,
) -> Result<BranchChoice> {
    let step = progress.clone();
    let scaled = move |done: f64, what: &str| step.report(SELECTION_SHARE * done, what);
    let settings = asked.settings.clone();
    Ok(choose_kind(app.archive(), version, trials, settings, Arc::new(scaled)).await?)
}

/// Completes a job that yields no version, as no learned correction is selected.
async fn complete_without_version(
    app: &App,
    job: &Job,
    asked: &BranchJob,
    tried: &BranchChoice,
) -> Result<()> {
    let foundation = format!("{}/{}", asked.ship, asked.number);
    let result = json!({ "foundation": foundation, "choice": tried, "branch": null });
    app.store().jobs().complete(&job.id, job.fence, &result.to_string()).await?;
    Ok(())
}
