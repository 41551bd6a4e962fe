//! Check of documents: their hashes, and the rows and objects that they name.

use serde_json::Value;
use sistership_model::version::sha256_hex;
use sistership_store::{Job, JobFilter, PageRequest, Result, StoreError, Version};

use super::findings::Findings;
use super::lookup::{PAGE_ROWS, describe_fault, describe_store_fault, object_exists};
use crate::archive::{Archive, version_document};
use crate::error::DeriveError;
use crate::version::VersionDocument;

pub(super) async fn check_laws(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        // Page by page: an archive may not fit into memory.
        let laws = archive.store.laws().list(&page).await?;
        for law in laws.items {
            findings.checked.laws += 1;
            check_hash(
                "law-hash",
                format!("law {}", law.name),
                &law.document,
                &law.sha256,
                findings,
            );
        }
        let Some(next) = laws.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

pub(super) async fn check_effects(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let libraries = archive.store.effect_libraries().list(&page).await?;
        for library in libraries.items {
            findings.checked.effects += 1;
            let place = format!("library of effects {}", library.sha256);
            check_hash("effects-hash", place, &library.document, &library.sha256, findings);
        }
        let Some(next) = libraries.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

pub(super) async fn check_versions(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let versions = archive.store.versions().list_all(&page).await?;
        for version in versions.items {
            findings.checked.versions += 1;
            self::check_version(archive, &version, findings).await?;
        }
        let Some(next) = versions.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

async fn check_version(
    archive: &Archive,
    version: &Version,
    findings: &mut Findings,
) -> Result<()> {
    let place = format!("version {}/{}", version.head.model, version.head.number);
    check_hash("version-hash", place.clone(), &version.document, &version.head.sha256, findings);
    // A damaged document is a finding; the check continues with the next version.
    match version_document(version) {
        Ok(document) => check_recipe(archive, version, &document, &place, findings).await,
        Err(error) => {
            findings.add_fault("version-document", place, describe_fault(error)?);
            Ok(())
        }
    }
}

/// Checks that everything that a recipe names exists with the hash that it names. The bytes of
/// trials are checked with the objects.
async fn check_recipe(
    archive: &Archive,
    version: &Version,
    document: &VersionDocument,
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    let recipe = &document.recipe;
    // The row could point to the document of another ship.
    if document.ship != version.head.model {
        findings.add_fault(
            "version-document",
            place.to_owned(),
            format!("its document names `{}`", document.ship),
        );
    }
    record_failure(
        "version-law",
        place,
        archive.law_by_hash(&version.head.law, recipe.law_sha256()).await.map(drop),
        findings,
    )?;
    if let Some(hash) = recipe.ship_sha256() {
        record_failure(
            "version-ship",
            place,
            archive.ship_by_hash(&document.ship, hash).await.map(drop),
            findings,
        )?;
    }
    for source in recipe.source_versions() {
        record_failure(
            "version-source",
            place,
            archive.source_model(source).await.map(drop),
            findings,
        )?;
    }
    if let Some(hash) = recipe.effects_sha256() {
        record_failure(
            "version-effects",
            place,
            archive.effect_library(hash).await.map(drop),
            findings,
        )?;
    }
    if let Some(prior) = recipe.family_prior() {
        record_failure(
            "version-prior",
            place,
            archive.family_prior(prior).await.map(drop),
            findings,
        )?;
    }
    check_weights(archive, document, place, findings).await?;
    // Only the presence: reading the samples of every version would repeat the check of the
    // objects.
    for trial in recipe.trials() {
        if !object_exists(&archive.objects, &trial.sha256).await? {
            let message =
                format!("the samples {} of its trial `{}` are missing", trial.sha256, trial.name);
            findings.add_fault("version-trial", place.to_owned(), message);
        }
    }
    Ok(())
}

/// Checks that the weights of a learned correction exist and that the version's row refers to them;
/// otherwise they would be removed as garbage.
async fn check_weights(
    archive: &Archive,
    document: &VersionDocument,
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    // The row has the key, too, because garbage collection asks the database and not the documents.
    let Some(branch) = &document.model.branch else { return Ok(()) };
    let key = &branch.weights_sha256;
    let mut add =
        |message: String| findings.add_fault("version-weights", place.to_owned(), message);
    if !object_exists(&archive.objects, key).await? {
        add(format!("the weights {key} of its learned correction are missing"));
    } else if !archive.store.unreferenced_keys(std::slice::from_ref(key)).await?.is_empty() {
        add(format!("its row does not refer to the weights {key} of its learned correction"));
    }
    Ok(())
}

pub(super) async fn check_jobs(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let jobs = archive.store.jobs().list(&JobFilter::default(), &page).await?;
        for job in jobs.items {
            findings.checked.jobs += 1;
            self::check_job(archive, &job, findings).await?;
        }
        let Some(next) = jobs.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

/// Checks the version and the report that a job's result names.
async fn check_job(archive: &Archive, job: &Job, findings: &mut Findings) -> Result<()> {
    // Jobs that are queued, running or failed have no result.
    let Some(result) = &job.result else { return Ok(()) };
    let place = format!("job {}", job.id);
    let Ok(result) = serde_json::from_str::<Value>(result) else {
        findings.add_fault("job-result", place, "its result is not a JSON document");
        return Ok(());
    };
    if let (Some(model), Some(number)) = (result["model"].as_str(), result["version"].as_i64()) {
        match archive.store.versions().get(model, number).await {
            Ok(version)
                if result["sha256"].as_str().is_none_or(|sha256| sha256 == version.head.sha256) => {
            }
            Ok(version) => {
                let message = format!(
                    "names another hash of version {model}/{number} than {}",
                    version.head.sha256
                );
                findings.add_fault("job-result", place.clone(), message);
            }
            Err(error) => {
                findings.add_fault("job-result", place.clone(), describe_store_fault(error)?)
            }
        }
    }
    if let Some(report) = result["report"].as_str() {
        let found = archive.store.reports().get(report).await;
        record_failure(
            "job-result",
            &place,
            found.map(drop).map_err(DeriveError::Store),
            findings,
        )?;
    }
    Ok(())
}

pub(super) async fn check_diagnoses(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = PageRequest::first_page(PAGE_ROWS);
    loop {
        let diagnoses = archive.store.diagnoses().list_all(&page).await?;
        for diagnosis in diagnoses.items {
            findings.checked.diagnoses += 1;
            let place = format!("diagnosis {}", diagnosis.id);
            match serde_json::from_str::<Vec<String>>(&diagnosis.trials) {
                Ok(trials) => check_diagnosed_trials(archive, &trials, &place, findings).await?,
                Err(_) => findings.add_fault(
                    "diagnosis-trials",
                    place,
                    "its trials are not a list of ids",
                ),
            }
        }
        let Some(next) = diagnoses.next else { return Ok(()) };
        page = PageRequest::after_key(next, PAGE_ROWS);
    }
}

/// Checks that the trials of a diagnosis exist or existed.
async fn check_diagnosed_trials(
    archive: &Archive,
    trials: &[String],
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    for trial in trials {
        // Deleted trials keep their row as a tombstone.
        if !archive.store.trials().ever_existed(trial).await? {
            findings.add_fault(
                "diagnosis-trials",
                place.to_owned(),
                format!("there is no trial {trial}"),
            );
        }
    }
    Ok(())
}

fn check_hash(
    check: &'static str,
    place: String,
    document: &str,
    recorded: &str,
    findings: &mut Findings,
) {
    let actual = sha256_hex(document.as_bytes());
    if actual != recorded {
        findings.add_fault(
            check,
            place,
            format!("its document has the hash {actual}, but {recorded} is recorded"),
        );
    }
}

/// Records a failed lookup as a finding; returns the error if the store itself did not answer.
fn record_failure(
    check: &'static str,
    place: &str,
    found: std::result::Result<(), DeriveError>,
    findings: &mut Findings,
) -> Result<(), StoreError> {
    if let Err(error) = found {
        findings.add_fault(check, place.to_owned(), describe_fault(error)?);
    }
    Ok(())
}
