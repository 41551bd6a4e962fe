//! Check of objects: the bytes of each, and the trials and versions that refer to them.

use std::collections::HashMap;

use futures::TryStreamExt as _;
use sistership_store::{ObjectHead, ObjectName, PageRequest, Result};

use super::findings::{Findings, UnreferencedObjects};
use super::lookup::{PAGE_ROWS, describe_store_fault, object_exists};
use crate::archive::Archive;

/// Reads every object, then checks the object of every trial. Objects come before rows: a trial
/// that is added meanwhile has its object, though perhaps not among those that were read.
pub(super) async fn check_objects(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut objects = HashMap::new();
    let mut all = archive.objects.list();
    while let Some(head) = all.try_next().await? {
        findings.checked.objects += 1;
        if let Some(key) = check_object(archive, &head, findings).await? {
            objects.insert(key, head.bytes);
        }
    }
    check_trials(archive, &mut objects, findings).await?;
    exclude_weights(archive, &mut objects).await?;
    findings.unreferred =
        UnreferencedObjects { objects: objects.len(), bytes: objects.values().sum() };
    let staged = archive.objects.list_staged().await?;
    findings.unfinished = UnreferencedObjects {
        objects: staged.len(),
        bytes: staged.iter().map(|staged| staged.bytes).sum(),
    };
    Ok(())
}

/// Checks the bytes of an object; returns its key, `None` if its name is no key.
async fn check_object(
    archive: &Archive,
    head: &ObjectHead,
    findings: &mut Findings,
) -> Result<Option<String>> {
    match &head.name {
        ObjectName::Stranger(path) => {
            findings.add_fault(
                "object-name",
                format!("object {path}"),
                "its name is not a hash: it was not written by the store",
            );
            Ok(None)
        }
        ObjectName::Key(key) => {
            // An object that is gone by now was removed as garbage; if a trial needs it, that is
            // reported with the trial.
            match archive.objects.get(key).await {
                Ok(_) | Err(sistership_store::StoreError::NotFound { .. }) => {}
                Err(error) => findings.add_fault(
                    "object-hash",
                    format!("object {key}"),
                    describe_store_fault(error)?,
                ),
            }
            Ok(Some(key.clone()))
        }
    }
}

/// Removes the weights of learned corrections from `objects`; missing ones are reported with their
/// version.
async fn exclude_weights(archive: &Archive, objects: &mut HashMap<String, u64>) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let keys = archive.store.versions().list_weights(&page).await?;
        for key in &keys.items {
            objects.remove(&key.weights_key);
        }
        let Some(next) = keys.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

/// Removes the objects of trials from `objects`, and reports missing ones.
async fn check_trials(
    archive: &Archive,
    objects: &mut HashMap<String, u64>,
    findings: &mut Findings,
) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let trials = archive.store.trials().list_all(&page).await?;
        for trial in trials.items {
            findings.checked.trials += 1;
            // Asked again: the object may have been stored after the list was read, or two trials
            // share it.
            if objects.remove(&trial.object_key).is_none()
                && !object_exists(&archive.objects, &trial.object_key).await?
            {
                let place = format!("trial {} of {}", trial.id, trial.ship);
                findings.add_fault(
                    "trial-object",
                    place,
                    format!("its samples {} are missing", trial.object_key),
                );
            }
        }
        let Some(next) = trials.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}
