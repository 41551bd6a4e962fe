//! The trials of a ship since its champion was fitted, and those of them that are diagnosed with
//! new ones.

use std::collections::BTreeSet;

use sistership_store::{MAX_LIMIT, Page, Trial, Version};

use crate::archive::{Archive, document};
use crate::error::DeriveError;

type Result<T> = std::result::Result<T, DeriveError>;

/// The most trials that are diagnosed together, the newest of them: time and memory of a diagnosis
/// grow as their samples, while the standard error of an effect that all trials have falls as
/// `1/sqrt(n)`. Twelve have it within 1.4 of what 24 would give at twice the cost. What is older
/// stays counted by its own diagnosis.
pub const NEWEST: usize = 12;

/// The ids of new trials of a version's ship with those before them since the version was fitted,
/// in the order of their upload: at most [`NEWEST`], and as many as `is_affordable` allows by their
/// samples. None where there are no others, or these have been diagnosed together.
///
/// # Errors
/// The store does not answer, or the version does not read.
pub async fn gathered(
    archive: &Archive,
    version: &Version,
    new: &[String],
    is_affordable: &(dyn Fn(u64) -> bool + Sync),
) -> Result<Option<Vec<String>>> {
    let trials = trials_since(archive, version).await?;
    let with_new = |trial: &&Trial| new.contains(&trial.id);
    let new_rows: u64 = trials.iter().filter(with_new).map(rows).sum();
    let earlier = trials.iter().rev().filter(|trial| !new.contains(&trial.id));
    let (mut ids, mut samples) = (new.to_vec(), new_rows);
    for trial in earlier.take(NEWEST.saturating_sub(new.len())) {
        samples += rows(trial);
        if !is_affordable(samples) {
            break;
        }
        ids.push(trial.id.clone());
    }
    ids.sort();
    let is_known = ids.len() == new.len() || is_diagnosed(archive, version, &ids).await?;
    Ok(if is_known { None } else { Some(ids) })
}

fn rows(trial: &Trial) -> u64 {
    u64::try_from(trial.sample_rows).unwrap_or(0)
}

/// Whether one of the newest diagnoses of a version is of these trials.
async fn is_diagnosed(archive: &Archive, version: &Version, ids: &[String]) -> Result<bool> {
    let page = Page::first(MAX_LIMIT);
    let known = archive.store.diagnoses().by_version(&version.head.id, &page).await?.items;
    let mut known = known.iter().filter(|known| known.version_id == version.head.id);
    Ok(known.any(|known| {
        let mut trials: Vec<String> = serde_json::from_str(&known.trials).unwrap_or_default();
        trials.sort();
        trials == ids
    }))
}

/// The trials of a ship that were uploaded after the last one that a version was made of; all of
/// them where it was made of none.
async fn trials_since(archive: &Archive, version: &Version) -> Result<Vec<Trial>> {
    let mut all = all_trials(archive, &version.head.model).await?;
    let fitted = fitted_samples(archive, version).await?;
    let last = all.iter().rposition(|trial| fitted.contains(&trial.sha256));
    Ok(all.split_off(last.map_or(0, |last| last + 1)))
}

/// The trials of a ship, the oldest first.
async fn all_trials(archive: &Archive, ship: &str) -> Result<Vec<Trial>> {
    let (mut all, mut page) = (Vec::new(), Page::first(MAX_LIMIT));
    loop {
        let trials = archive.store.trials().list(ship, &page).await?;
        all.extend(trials.items);
        let Some(next) = trials.next else { return Ok(all) };
        page = Page::after(next, MAX_LIMIT);
    }
}

/// The hashes of the trials that a version was made of, and of those that went into the versions
/// that were diagnosed for it.
///
/// # Errors
/// The store does not answer, or a version does not read.
pub async fn fitted_samples(archive: &Archive, version: &Version) -> Result<BTreeSet<String>> {
    let mut recipe = document(version)?.recipe;
    let mut fitted = BTreeSet::new();
    loop {
        fitted.extend(recipe.trials().iter().map(|trial| trial.sha256.clone()));
        let Some(earlier) = recipe.diagnosed() else { return Ok(fitted) };
        let earlier = archive.store.versions().get(&earlier.ship, earlier.number).await?;
        recipe = document(&earlier)?.recipe;
    }
}
