//! The job that learns a prior from a family of ships.

use serde_json::json;
use sistership_store::Job;

use super::outcome::{Result, failed};
use super::progress::Progress;
use crate::app::App;
use sistership_jobs::fleet::{LearnJob, learn};

/// Learns a prior, and keeps it as the next revision of the family's prior.
pub(super) async fn run(app: &App, job: &Job, progress: Progress) -> Result<()> {
    let asked: LearnJob = serde_json::from_str(&job.request).map_err(failed)?;
    let told = move |fraction: f64, what: &str| progress.tell(fraction, what);
    let prior = learn(app.archive(), &asked.family, &told).await?;
    let document = serde_json::to_string(&prior).map_err(failed)?;
    let result = |kept: &sistership_store::FamilyPrior| {
        json!({ "family": kept.family, "revision": kept.revision, "sha256": kept.sha256,
            "members": prior.members.len(),
            "design_effect": prior.design_effect })
        .to_string()
    };
    app.store().families().commit(&asked.family, &document, (&job.id, job.fence), result).await?;
    Ok(())
}
