//! The job that learns a prior from a family of ships.

use serde_json::json;
use sistership_store::Job;

use super::outcome::{Result, permanent_failure};
use super::progress::JobProgress;
use crate::app::App;
use sistership_jobs::fleet::{LearnJob, learn_family_prior};

/// Learns a prior, and keeps it as the next revision of the family's prior.
pub(super) async fn run_learning(app: &App, job: &Job, progress: JobProgress) -> Result<()> {
    let asked: LearnJob = serde_json::from_str(&job.request).map_err(permanent_failure)?;
    let told = move |fraction: f64, what: &str| progress.report(fraction, what);
    let prior = learn_family_prior(app.archive(), &asked.family, &told).await?;
    let document = serde_json::to_string(&prior).map_err(permanent_failure)?;
    let result = |kept: &sistership_store::FamilyPrior| {
        json!({ "family": kept.family, "revision": kept.revision, "sha256": kept.sha256,
            "members": prior.members.len(),
            "design_effect": prior.design_effect })
        .to_string()
    };
    app.store()
        .families()
        .commit_prior(&asked.family, &document, (&job.id, job.fence), result)
        .await?;
    Ok(())
}
