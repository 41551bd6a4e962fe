//! The diagnosis job: its recipe, and what comes of it.

use std::sync::Arc;

use sistership_model::version::SourceVersion;
use sistership_store::{Job, Version};

use super::commit_diagnosis::commit;
use super::outcome::{Result, failed};
use super::prepared::trials;
use super::progress::Progress;
use super::progress::tell;
use crate::app::App;
use sistership_jobs::derive::diagnosed;
use sistership_jobs::recipe::{DiagnosisKind, DiagnosisRecipe};
use sistership_jobs::request::DiagnosisJob;
use sistership_jobs::sorted::sorted;
use sistership_jobs::start::library_of;
use sistership_model::version::code_revision;

/// Does a diagnosis.
pub(super) async fn run(app: &App, job: &Job, progress: Progress) -> Result<()> {
    let asked: DiagnosisJob = serde_json::from_str(&job.request).map_err(failed)?;
    tell(&progress, 0.01, "reading the trials")?;
    let version = app.store().versions().get(&asked.ship, asked.number).await?;
    let recipe = recipe(app, &asked, &version).await?;
    let step = progress.clone();
    let scaled = move |fraction: f64, what: &str| step.tell(0.05 + 0.85 * fraction, what);
    let diagnosed = diagnosed(app.archive(), recipe, Arc::new(scaled)).await?;
    tell(&progress, 0.92, "writing the report")?;
    commit(app, job, diagnosed, &version.head, &asked.trials).await
}

async fn recipe(app: &App, asked: &DiagnosisJob, version: &Version) -> Result<DiagnosisRecipe> {
    let (ship, number, sha256) =
        (version.head.model.clone(), version.head.number, version.head.sha256.clone());
    let law = app.store().laws().get(&version.head.law).await?;
    Ok(DiagnosisRecipe {
        kind: DiagnosisKind::Diagnosis,
        diagnosed: SourceVersion { ship, number, sha256 },
        law_sha256: law.sha256,
        trials: trials(app, &asked.trials).await?,
        effects_sha256: library_of(app.archive()).await?.sha256.clone(),
        settings: sorted(serde_json::to_value(&asked.settings).map_err(failed)?),
        code_revision: code_revision().to_owned(),
    })
}
