//! Garbage collection of objects.

use std::collections::HashSet;
use std::time::Duration;

use futures::TryStreamExt as _;
use serde::Serialize;
use sistership_store::{ObjectHead, ObjectName, PageRequest, Result};

use super::lookup::PAGE_ROWS;
use crate::archive::{Archive, version_document};

/// Number of keys in one transaction, during which uploads wait.
const REMOVAL_BATCH: usize = 100;
/// Time after which an upload that has not been written to counts as interrupted: one hour.
const LONGEST_PUT_US: i64 = 3_600_000_000;

/// Objects that were removed, or would be.
#[derive(Debug, Default, Clone, PartialEq, Eq, Serialize)]
pub struct RemovedObjects {
    /// True if nothing was removed.
    pub dry_run: bool,
    /// The keys.
    pub removed: Vec<String>,
    /// Files of interrupted uploads.
    pub unfinished: Vec<String>,
    /// Total size of both, bytes.
    pub bytes: u64,
    /// Number of objects that were examined.
    pub objects: usize,
}

/// Removes the objects that no trial and no version refers to and that were stored longer than
/// `grace` ago. Other processes may write at the same time.
///
/// # Errors
/// Returns an error if the database or the object store does not answer; objects removed before
/// that stay removed.
pub async fn collect_garbage(
    archive: &Archive,
    grace: Duration,
    dry_run: bool,
) -> Result<RemovedObjects> {
    let named = keys_of_versions(archive).await?;
    let before_us =
        archive.store.now_us().saturating_sub(i64::try_from(grace.as_micros()).unwrap_or(i64::MAX));
    let mut collected = RemovedObjects { dry_run, ..RemovedObjects::default() };
    let mut old = Vec::new();
    let mut all = archive.objects.list();
    while let Some(head) = all.try_next().await? {
        collected.objects += 1;
        // Only candidates are collected, not the whole list of objects.
        old.extend(removal_candidate(head, before_us, &named));
    }
    for some in old.chunks(REMOVAL_BATCH) {
        let keys: Vec<String> = some.iter().map(|(key, _)| key.clone()).collect();
        // References are checked again in the transaction that removes: a trial may have been added
        // since the objects were listed.
        let removed = match dry_run {
            true => archive.store.unreferenced_keys(&keys).await?,
            false => archive.store.remove_unreferenced(&archive.objects, &keys).await?,
        };
        collected.bytes += some
            .iter()
            .filter(|(key, _)| removed.contains(key))
            .map(|(_, bytes)| bytes)
            .sum::<u64>();
        collected.removed.extend(removed);
    }
    remove_unfinished(archive, before_us, &mut collected).await?;
    Ok(collected)
}

/// Removes the files of interrupted uploads. No row can refer to them.
async fn remove_unfinished(
    archive: &Archive,
    before_us: i64,
    collected: &mut RemovedObjects,
) -> Result<()> {
    // Even with a grace of zero an upload in progress is kept.
    let before_us = before_us.min(archive.store.now_us() - LONGEST_PUT_US);
    for staged in archive
        .objects
        .list_staged()
        .await?
        .into_iter()
        .filter(|staged| staged.modified_us < before_us)
    {
        if !collected.dry_run {
            archive.objects.remove_staged(&staged).await?;
        }
        collected.bytes += staged.bytes;
        collected.unfinished.push(staged.path);
    }
    Ok(())
}

/// Returns key and size of an object that is old enough and that no version names. A file that is
/// not named by a hash was not written by the store.
fn removal_candidate(
    head: ObjectHead,
    before_us: i64,
    named: &HashSet<String>,
) -> Option<(String, u64)> {
    match head.name {
        ObjectName::Key(key) if head.modified_us < before_us && !named.contains(&key) => {
            Some((key, head.bytes))
        }
        _ => None,
    }
}

/// Returns the keys of samples and weights that versions name. Trials have rows for samples; if
/// such a row is lost, its samples must not be removed.
async fn keys_of_versions(archive: &Archive) -> Result<HashSet<String>> {
    let (mut named, mut page) = (HashSet::new(), PageRequest::first_page(PAGE_ROWS));
    loop {
        let versions = archive.store.versions().list_all(&page).await?;
        for version in &versions.items {
            // The references of a damaged document are unknown; `fsck` reports it.
            let Ok(document) = version_document(version) else { continue };
            named.extend(document.recipe.trials().iter().map(|trial| trial.sha256.clone()));
            named.extend(document.model.branch.map(|branch| branch.weights_sha256));
        }
        let Some(next) = versions.next else { return Ok(named) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}
