//! Check of documents: their hashes, and the rows and objects that they name.

use serde_json::Value;
use sistership_model::version::sha256;
use sistership_store::{Job, JobFilter, Page, Result, StoreError, Version};

use super::findings::Findings;
use super::reading::{ROWS, fault, store_fault, there};
use crate::archive::{Archive, document};
use crate::error::DeriveError;
use crate::version::VersionDocument;

pub(super) async fn laws(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = Page::first(ROWS);
    loop {
        // Page by page: an archive may not fit into memory.
        let laws = archive.store.laws().list(&page).await?;
        for law in laws.items {
            findings.checked.laws += 1;
            hash("law-hash", format!("law {}", law.name), &law.document, &law.sha256, findings);
        }
        let Some(next) = laws.next else { return Ok(()) };
        page = Page::after(next, ROWS);
    }
}

pub(super) async fn effects(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = Page::first(ROWS);
    loop {
        let libraries = archive.store.effects().list(&page).await?;
        for library in libraries.items {
            findings.checked.effects += 1;
            let place = format!("library of effects {}", library.sha256);
            hash("effects-hash", place, &library.document, &library.sha256, findings);
        }
        let Some(next) = libraries.next else { return Ok(()) };
        page = Page::after(next, ROWS);
    }
}

pub(super) async fn versions(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = Page::first(ROWS);
    loop {
        let versions = archive.store.versions().all(&page).await?;
        for version in versions.items {
            findings.checked.versions += 1;
            self::version(archive, &version, findings).await?;
        }
        let Some(next) = versions.next else { return Ok(()) };
        page = Page::after(next, ROWS);
    }
}

async fn version(archive: &Archive, version: &Version, findings: &mut Findings) -> Result<()> {
    let place = format!("version {}/{}", version.head.model, version.head.number);
    hash("version-hash", place.clone(), &version.document, &version.head.sha256, findings);
    // A damaged document is a finding; the check continues with the next version.
    match document(version) {
        Ok(document) => recipe(archive, version, &document, &place, findings).await,
        Err(error) => {
            findings.add("version-document", place, fault(error)?);
            Ok(())
        }
    }
}

/// Checks that everything that a recipe names exists with the hash that it names. The bytes of
/// trials are checked with the objects.
async fn recipe(
    archive: &Archive,
    version: &Version,
    document: &VersionDocument,
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    let recipe = &document.recipe;
    // The row could point to the document of another ship.
    if document.ship != version.head.model {
        findings.add(
            "version-document",
            place.to_owned(),
            format!("its document is about `{}`", document.ship),
        );
    }
    told(
        "version-law",
        place,
        archive.law(&version.head.law, recipe.law_sha256()).await.map(drop),
        findings,
    )?;
    if let Some(hash) = recipe.ship_sha256() {
        told("version-ship", place, archive.ship(&document.ship, hash).await.map(drop), findings)?;
    }
    for source in recipe.versions() {
        told("version-source", place, archive.source(source).await.map(drop), findings)?;
    }
    if let Some(hash) = recipe.effects_sha256() {
        told("version-effects", place, archive.effects(hash).await.map(drop), findings)?;
    }
    if let Some(prior) = recipe.prior() {
        told("version-prior", place, archive.prior(prior).await.map(drop), findings)?;
    }
    weights(archive, document, place, findings).await?;
    // Only the presence: reading the samples of every version would repeat the check of the
    // objects.
    for trial in recipe.trials() {
        if !there(&archive.objects, &trial.sha256).await? {
            let message =
                format!("the samples {} of its trial `{}` are missing", trial.sha256, trial.name);
            findings.add("version-trial", place.to_owned(), message);
        }
    }
    Ok(())
}

/// Checks that the weights of a learned correction exist and that the version's row refers to them;
/// otherwise they would be removed as garbage.
async fn weights(
    archive: &Archive,
    document: &VersionDocument,
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    // The row has the key, too, because garbage collection asks the database and not the documents.
    let Some(branch) = &document.model.branch else { return Ok(()) };
    let key = &branch.weights_sha256;
    let mut add = |message: String| findings.add("version-weights", place.to_owned(), message);
    if !there(&archive.objects, key).await? {
        add(format!("the weights {key} of its learned branch are missing"));
    } else if !archive.store.unreferred(std::slice::from_ref(key)).await?.is_empty() {
        add(format!("its row does not refer to the weights {key} of its learned branch"));
    }
    Ok(())
}

pub(super) async fn jobs(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = Page::first(ROWS);
    loop {
        let jobs = archive.store.jobs().list(&JobFilter::default(), &page).await?;
        for job in jobs.items {
            findings.checked.jobs += 1;
            self::job(archive, &job, findings).await?;
        }
        let Some(next) = jobs.next else { return Ok(()) };
        page = Page::after(next, ROWS);
    }
}

/// Checks the version and the report that a job's result names.
async fn job(archive: &Archive, job: &Job, findings: &mut Findings) -> Result<()> {
    // Jobs that are queued, running or failed have no result.
    let Some(result) = &job.result else { return Ok(()) };
    let place = format!("job {}", job.id);
    let Ok(result) = serde_json::from_str::<Value>(result) else {
        findings.add("job-result", place, "its result is no JSON document");
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
                findings.add("job-result", place.clone(), message);
            }
            Err(error) => findings.add("job-result", place.clone(), store_fault(error)?),
        }
    }
    if let Some(report) = result["report"].as_str() {
        let found = archive.store.reports().get(report).await;
        told("job-result", &place, found.map(drop).map_err(DeriveError::Store), findings)?;
    }
    Ok(())
}

pub(super) async fn diagnoses(archive: &Archive, findings: &mut Findings) -> Result<()> {
    let mut page = Page::first(ROWS);
    loop {
        let diagnoses = archive.store.diagnoses().all(&page).await?;
        for diagnosis in diagnoses.items {
            findings.checked.diagnoses += 1;
            let place = format!("diagnosis {}", diagnosis.id);
            match serde_json::from_str::<Vec<String>>(&diagnosis.trials) {
                Ok(trials) => diagnosed(archive, &trials, &place, findings).await?,
                Err(_) => findings.add("diagnosis-trials", place, "its trials are no list of ids"),
            }
        }
        let Some(next) = diagnoses.next else { return Ok(()) };
        page = Page::after(next, ROWS);
    }
}

/// Checks that the trials of a diagnosis exist or existed.
async fn diagnosed(
    archive: &Archive,
    trials: &[String],
    place: &str,
    findings: &mut Findings,
) -> Result<()> {
    for trial in trials {
        // Deleted trials keep their row as a tombstone.
        if !archive.store.trials().was(trial).await? {
            findings.add(
                "diagnosis-trials",
                place.to_owned(),
                format!("there is no trial {trial}"),
            );
        }
    }
    Ok(())
}

fn hash(
    check: &'static str,
    place: String,
    document: &str,
    recorded: &str,
    findings: &mut Findings,
) {
    let actual = sha256(document.as_bytes());
    if actual != recorded {
        findings.add(
            check,
            place,
            format!("its document has the hash {actual}, not {recorded} as recorded"),
        );
    }
}

/// Records a failed lookup as a finding; returns the error if the store itself did not answer.
fn told(
    check: &'static str,
    place: &str,
    found: std::result::Result<(), DeriveError>,
    findings: &mut Findings,
) -> Result<(), StoreError> {
    if let Err(error) = found {
        findings.add(check, place.to_owned(), fault(error)?);
    }
    Ok(())
}
