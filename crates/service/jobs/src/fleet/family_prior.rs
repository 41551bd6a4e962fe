//! Estimation of the prior of a family.

use serde::{Deserialize, Serialize};
use sistership_fleet::family::{self, FamilyMember, FamilyPrior};
use sistership_fleet::statistics::{RegressionFrame, TrialStatistics};
use sistership_model::version::{RecipeTrial, SourceVersion};

use super::choices::Start;
use super::frame::StartingModels;
use super::members::member_names;
use super::stored_statistics::trial_statistics;
use crate::archive::{Archive, version_document};
use crate::error::DeriveError;
use crate::ship_trials::all_trials;

/// Kind of the jobs that estimate a family's prior.
pub const PRIOR_JOB_KIND: &str = "family-prior";
/// Largest number of members that are used, evenly spaced: more add little.
const MAX_LEARNED_MEMBERS: usize = 1000;

/// Request of such a job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LearnJob {
    /// The family.
    pub family: String,
}

/// Estimates mean and covariance of the coefficients over the members that have trials. The
/// callback receives the progress and may stop it.
///
/// # Errors
/// Returns an error if a document is missing or damaged, or if the members do not determine a
/// prior.
pub async fn learn_family_prior(
    archive: &Archive,
    name: &str,
    told: &(dyn Fn(f64, &str) -> bool + Sync),
) -> Result<FamilyPrior, DeriveError> {
    let store = &archive.store;
    let family = store.families().get(name).await?;
    let foundation = store.versions().by_id(&family.foundation).await?;
    let law_sha256 = store.laws().get(&foundation.head.law).await?.sha256;
    let law = archive.law_by_hash(&foundation.head.law, &law_sha256).await?;
    let model = version_document(&foundation)?.model;
    let head = foundation.head;
    let source = SourceVersion { ship: head.model, number: head.number, sha256: head.sha256 };
    let frames = StartingModels { archive, foundation: &source, model: &model, law: &law };
    let ships = select_evenly(member_names(store, name).await?);
    let mut known: Vec<(String, Vec<TrialStatistics>)> = Vec::new();
    for (index, ship) in ships.iter().enumerate() {
        if !told(0.9 * index as f64 / ships.len() as f64, &format!("statistics of {ship}")) {
            return Err(DeriveError::Refine(
                sistership_identification::refine::RefineError::Cancelled,
            ));
        }
        // A member without usable statistics is skipped, it does not end the job.
        known.extend(
            member_statistics(&frames, ship, &law_sha256)
                .await?
                .map(|statistics| (ship.clone(), statistics)),
        );
    }
    // The estimation itself cannot be stopped.
    told(0.9, "learning");
    let learned = tokio::task::spawn_blocking(move || {
        let members: Vec<FamilyMember<'_>> =
            known.iter().map(|(name, trials)| FamilyMember { name, trials }).collect();
        family::learn_family(&members)
    });
    learned.await?.map_err(|error| DeriveError::Lost(error.to_string()))
}

/// Returns the statistics of a member; `None` for a member without trials, or whose model has
/// another law or other coefficients.
async fn member_statistics(
    frames: &StartingModels<'_>,
    ship: &str,
    law_sha256: &str,
) -> Result<Option<Vec<TrialStatistics>>, DeriveError> {
    let trials = recipe_trials(frames.archive, ship).await?;
    let framed = match frames.for_member(ship, Start::Champion).await {
        Ok(framed) => framed,
        Err(DeriveError::Lost(reason)) => {
            tracing::info!(ship, reason, "not used for the prior");
            return Ok(None);
        }
        Err(error) => return Err(error),
    };
    // Each member has the frame of its own model.
    let frame = match RegressionFrame::new(&framed.model, frames.law, law_sha256, None) {
        Ok(frame) if !trials.is_empty() => frame,
        _ => return Ok(None),
    };
    trial_statistics(frames.archive, &frame, &trials).await.map(Some)
}

/// Reads the trials of a ship, oldest first.
pub async fn recipe_trials(archive: &Archive, ship: &str) -> Result<Vec<RecipeTrial>, DeriveError> {
    let trials = all_trials(&archive.store, ship).await?.into_iter();
    Ok(trials.map(|trial| RecipeTrial { name: trial.name, sha256: trial.sha256 }).collect())
}

/// Selects a limited number of ships, evenly spaced.
fn select_evenly(ships: Vec<String>) -> Vec<String> {
    let every = ships.len().div_ceil(MAX_LEARNED_MEMBERS).max(1);
    ships.into_iter().step_by(every).collect()
}
