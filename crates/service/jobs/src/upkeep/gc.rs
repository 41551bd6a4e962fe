//! Removing objects that nobody needs.

use std::collections::HashSet;
use std::time::Duration;

use futures::TryStreamExt as _;
use serde::Serialize;
use sistership_store::{ObjectHead, ObjectName, Page, Result};

use super::reading::ROWS;
use crate::archive::{Archive, document};

/// Keys looked at in one transaction, which keeps uploads waiting.
const AT_ONCE: usize = 100;
/// What was last written longer ago than this is not being put any more: an hour.
const LONGEST_PUT_US: i64 = 3_600_000_000;

/// What was removed, or would have been.
#[derive(Debug, Default, Clone, PartialEq, Eq, Serialize)]
pub struct Collected {
    /// Whether everything was left in its place.
    pub dry_run: bool,
    /// The keys.
    pub removed: Vec<String>,
    /// Files of puts that never ended.
    pub unfinished: Vec<String>,
    /// The size of both.
    pub bytes: u64,
    /// Objects that were looked at.
    pub objects: usize,
}

/// Removes the objects that no trial and no version refers to and that were put longer than `grace`
/// ago. Others may write meanwhile.
///
/// # Errors
/// The database or the object store does not answer; what has been removed by then is gone.
pub async fn gc(archive: &Archive, grace: Duration, dry_run: bool) -> Result<Collected> {
    let named = named(archive).await?;
    let before_us =
        archive.store.now_us().saturating_sub(i64::try_from(grace.as_micros()).unwrap_or(i64::MAX));
    let mut collected = Collected { dry_run, ..Collected::default() };
    let mut old = Vec::new();
    let mut all = archive.objects.list();
    while let Some(head) = all.try_next().await? {
        collected.objects += 1;
        old.extend(candidate(head, before_us, &named));
    }
    for some in old.chunks(AT_ONCE) {
        let keys: Vec<String> = some.iter().map(|(key, _)| key.clone()).collect();
        let removed = match dry_run {
            true => archive.store.unreferred(&keys).await?,
            false => archive.store.remove_unreferred(&archive.objects, &keys).await?,
        };
        collected.bytes += some
            .iter()
            .filter(|(key, _)| removed.contains(key))
            .map(|(_, bytes)| bytes)
            .sum::<u64>();
        collected.removed.extend(removed);
    }
    unfinished(archive, before_us, &mut collected).await?;
    Ok(collected)
}

/// Removes what puts have left that never ended. No row can refer to it.
async fn unfinished(archive: &Archive, before_us: i64, collected: &mut Collected) -> Result<()> {
    let before_us = before_us.min(archive.store.now_us() - LONGEST_PUT_US);
    for staged in
        archive.objects.staged().await?.into_iter().filter(|staged| staged.modified_us < before_us)
    {
        if !collected.dry_run {
            archive.objects.remove_staged(&staged).await?;
        }
        collected.bytes += staged.bytes;
        collected.unfinished.push(staged.path);
    }
    Ok(())
}

/// Key and size of an object that is old enough and that no version names. What is not named by a
/// hash is not ours.
fn candidate(head: ObjectHead, before_us: i64, named: &HashSet<String>) -> Option<(String, u64)> {
    match head.name {
        ObjectName::Key(key) if head.modified_us < before_us && !named.contains(&key) => {
            Some((key, head.bytes))
        }
        _ => None,
    }
}

/// The samples and weights that versions name. Trials have rows for samples; where such a row is
/// lost, its samples must not go as well.
async fn named(archive: &Archive) -> Result<HashSet<String>> {
    let (mut named, mut page) = (HashSet::new(), Page::first(ROWS));
    loop {
        let versions = archive.store.versions().all(&page).await?;
        for version in &versions.items {
            // What a damaged document named cannot be known; `fsck` tells of it.
            let Ok(document) = document(version) else { continue };
            named.extend(document.recipe.trials().iter().map(|trial| trial.sha256.clone()));
            named.extend(document.model.branch.map(|branch| branch.weights_sha256));
        }
        let Some(next) = versions.next else { return Ok(named) };
        page = Page::after(next, ROWS);
    }
}
