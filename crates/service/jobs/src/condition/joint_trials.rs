//! Selection of the trials that are diagnosed together with new ones: those since the champion was
//! fitted.

use std::collections::BTreeSet;

use sistership_store::{Trial, Version, read_all_pages};

use crate::archive::{Archive, version_document};
use crate::error::DeriveError;
use crate::ship_trials::all_trials;

type Result<T> = std::result::Result<T, DeriveError>;

/// Largest number of trials that are diagnosed together, the newest ones: time and memory of a
/// diagnosis grow with the number of samples, while the standard error of an effect that all trials
/// have falls as `1/sqrt(n)`. With twelve it is 1.4 times that of 24, at half the cost. Older
/// trials count by their own diagnosis.
pub const MAX_JOINT_TRIALS: usize = 12;

/// Returns the ids of new trials together with earlier ones since the version was fitted, in the
/// order of their upload: a limited number, and as many as `is_affordable` allows by their number
/// of samples. `None` if there are no earlier trials, or if these have been diagnosed together.
///
/// # Errors
/// Returns an error if the store does not answer, or if the version cannot be read.
pub async fn trials_to_diagnose(
    archive: &Archive,
    version: &Version,
    new: &[String],
    is_affordable: &(dyn Fn(u64) -> bool + Sync),
) -> Result<Option<Vec<String>>> {
    let trials = trials_since(archive, version).await?;
    let with_new = |trial: &&Trial| new.contains(&trial.id);
    let new_rows: u64 = trials.iter().filter(with_new).map(sample_count).sum();
    let earlier = trials.iter().rev().filter(|trial| !new.contains(&trial.id));
    // Earlier trials are added from the newest back until number or memory is exhausted.
    let (mut ids, mut samples) = (new.to_vec(), new_rows);
    for trial in earlier.take(MAX_JOINT_TRIALS.saturating_sub(new.len())) {
        samples += sample_count(trial);
        if !is_affordable(samples) {
            break;
        }
        ids.push(trial.id.clone());
    }
    // Ids are ordered by time of upload.
    ids.sort();
    // The same set of trials is not diagnosed twice.
    let is_known = ids.len() == new.len() || is_diagnosed(archive, version, &ids).await?;
    Ok(if is_known { None } else { Some(ids) })
}

fn sample_count(trial: &Trial) -> u64 {
    u64::try_from(trial.sample_rows).unwrap_or(0)
}

/// Returns true if one of the diagnoses of a version has exactly these trials.
async fn is_diagnosed(archive: &Archive, version: &Version, ids: &[String]) -> Result<bool> {
    let (diagnoses, id) = (archive.store.diagnoses(), version.head.id.as_str());
    let known = read_all_pages(|page| async move { diagnoses.by_version(id, &page).await }).await?;
    let mut known = known.iter().filter(|known| known.version_id == version.head.id);
    Ok(known.any(|known| {
        let mut trials: Vec<String> = serde_json::from_str(&known.trials).unwrap_or_default();
        trials.sort();
        trials == ids
    }))
}

/// Returns the trials of a ship that were uploaded after the last one that a version was fitted on;
/// all of them if it was fitted on none.
async fn trials_since(archive: &Archive, version: &Version) -> Result<Vec<Trial>> {
    let mut all = all_trials(&archive.store, &version.head.model).await?;
    let fitted = fitted_samples(archive, version).await?;
    let last = all.iter().rposition(|trial| fitted.contains(&trial.sha256));
    Ok(all.split_off(last.map_or(0, |last| last + 1)))
}

/// Returns the hashes of the trials that a version was fitted on, and of those of the versions
/// whose diagnosis led to it.
///
/// # Errors
/// Returns an error if the store does not answer, or if a version cannot be read.
pub async fn fitted_samples(archive: &Archive, version: &Version) -> Result<BTreeSet<String>> {
    let mut recipe = version_document(version)?.recipe;
    let mut fitted = BTreeSet::new();
    loop {
        fitted.extend(recipe.trials().iter().map(|trial| trial.sha256.clone()));
        // A version with effects comes from a diagnosis of an earlier version, whose trials count,
        // too.
        let Some(earlier) = recipe.diagnosed_version() else { return Ok(fitted) };
        let earlier = archive.store.versions().get(&earlier.ship, earlier.number).await?;
        recipe = version_document(&earlier)?.recipe;
    }
}
