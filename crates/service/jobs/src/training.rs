//! Recipe of a learned correction.

use sistership_identification::refine::RefineError;
use sistership_learned::{
    BranchChoice, BranchKind, BranchSettings, HeldOutFold, HeldOutTrials, KindSearch, select_kind,
};
use sistership_model::trial::Trial;
use sistership_model::version::{RecipeTrial, SourceVersion, code_revision};
use sistership_store::Version;

use crate::archive::{Archive, version_document};
use crate::derive::ProgressCallback;
use crate::error::DeriveError;
use crate::recipe::{TrainingKind, TrainingRecipe};
use crate::start::stored_library;

/// Returns the recipe of a learned correction of a version, with all settings resolved.
///
/// # Errors
/// Returns an error if the version has a learned correction already or cannot be simulated, or if a
/// part of it is missing.
pub async fn training_recipe(
    archive: &Archive,
    version: &Version,
    trials: Vec<RecipeTrial>,
    settings: &BranchSettings,
) -> Result<TrainingRecipe, DeriveError> {
    let stored = version_document(version)?;
    let law_sha256 = stored.recipe.law_sha256().to_owned();
    let law = archive.law_by_hash(&stored.model.law, &law_sha256).await?;
    // The samples are read here, because defaults such as the window depend on them.
    let read = archive.read_trials(&trials).await?;
    let read: Vec<&Trial> = read.iter().collect();
    let settings = settings
        .complete_training(&stored.model, &law, &read)
        .map_err(|error| DeriveError::Lost(error.to_string()))?;
    let head = &version.head;
    let (ship, number, sha256) = (head.model.clone(), head.number, head.sha256.clone());
    Ok(TrainingRecipe {
        kind: TrainingKind::Branch,
        foundation: SourceVersion { ship, number, sha256 },
        law_sha256,
        trials,
        effects_sha256: stored_library(archive).await?.sha256.clone(),
        settings,
        code_revision: code_revision().to_owned(),
    })
}

/// Compares all kinds on held-out trials; `settings` leave the kind open.
///
/// # Errors
/// Same as [`training_recipe`]; also if a trial cannot be used for training, or if it was
/// cancelled.
pub async fn choose_kind(
    archive: &Archive,
    version: &Version,
    trials: &[RecipeTrial],
    settings: BranchSettings,
    progress: ProgressCallback,
) -> Result<BranchChoice, DeriveError> {
    let stored = version_document(version)?;
    let law = archive.law_by_hash(&stored.model.law, stored.recipe.law_sha256()).await?;
    let read = archive.read_trials(trials).await?;
    let work = move || -> Result<BranchChoice, DeriveError> {
        let read: Vec<&Trial> = read.iter().collect();
        let told = |kind: BranchKind| progress(0.1, &format!("trying {}", kind.name()));
        // The foundation is the same in every fold.
        let folds = HeldOutFold::with_one_foundation(&stored.model, read.len());
        let on = HeldOutTrials { law: &law, trials: &read, folds: &folds };
        let choice = select_kind(&stored.model, &on, (&settings, KindSearch::Every), &told)?;
        choice.ok_or(DeriveError::Refine(RefineError::Cancelled))
    };
    tokio::task::spawn_blocking(work).await?
}

/// Returns the number of the version without learned correction from which a corrected version
/// comes; the version itself if it has none, `None` if it was made elsewhere.
///
/// # Errors
/// Returns an error if the store does not answer, or if a version cannot be read.
pub async fn foundation_number(
    archive: &Archive,
    ship: &str,
    number: i64,
) -> Result<Option<i64>, DeriveError> {
    let mut number = number;
    loop {
        let stored = version_document(&archive.store.versions().get(ship, number).await?)?;
        // Diagnoses may have added effects to a corrected version, so there may be several steps.
        if stored.model.branch.is_none() {
            return Ok(Some(number));
        }
        let Some(earlier) = stored.recipe.source_version() else { return Ok(None) };
        number = earlier.number;
    }
}
